#include "misfit/workflow/session/study_change.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <misfit_models_registry.h>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/data/study_reader.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Two experiments, one with a recording of its own held out.
class ChangedStudy : public testing::Test {
 protected:
  ChangedStudy() {
    for (const char* file : {"a.csv", "b.csv", "c.csv"}) folder.write(file, "t[s],y[m]\n0,1\n1,2\n");
    folder.write("study.toml", text);
  }
  [[nodiscard]] std::string with(const std::string& words) const {
    return with_settings(read_study(folder.path() / "study.toml"), {read_setting(words)});
  }
  const std::string text =
      "[study]\nname = \"two\"  # two\n[system]\nkind = \"x\"\n[[experiment]]\ndata = \"a.csv\"\nvalidation = \"c.csv\"\n"
      "[[experiment]]\nname = \"the=second\"\ndata = \"b.csv\"\n[effects]\n";
  TemporaryFolder folder;
};

TEST_F(ChangedStudy, AnExperimentGoesByItsName) {
  EXPECT_THAT(with("experiment.a.validation=[0.5, 1]"), HasSubstr("data = \"a.csv\"\nvalidation = [0.5, 1]\n[[experiment]]\n"));
  EXPECT_THAT(with("experiment.\"the=second\".exclude=3"), HasSubstr("data = \"b.csv\"\nexclude = 3\n[effects]\n"));
  EXPECT_THAT([&] { (void)with("experiment.thesecond.exclude=3"); },
              ThrowsMessage<InputError>(HasSubstr("no experiment is called 'thesecond' — did you mean 'the=second'?")));
}

TEST_F(ChangedStudy, ARecordingThatAnotherExperimentHoldsOutHasNoKeysOfItsOwn) {
  EXPECT_THAT([&] { (void)with("experiment.\"a validation\".validation=[0.5, 1]"); },
              ThrowsMessage<InputError>(HasSubstr("'a validation' is the recording that 'a' holds out as a whole")));
}

TEST_F(ChangedStudy, ExperimentsGoByTheirNamesHoweverTheyAreWritten) {
  const std::string rest = "[system]\nkind = \"x\"\n[effects]\n";
  folder.write("study.toml", "[experiment]\nname = \"steps\"\ndata = \"a.csv\"\n" + rest);
  EXPECT_THAT(with("experiment.steps.validation=[0.5, 1]"), HasSubstr("data = \"a.csv\"\nvalidation = [0.5, 1]\n[system]\n"));
  folder.write("study.toml", "experiment = [{ data = \"a.csv\" }, { data = \"b.csv\" }]\n" + rest);
  EXPECT_THAT(with("experiment.b.exclude=3"), HasSubstr("{ data = \"a.csv\" }, { data = \"b.csv\", exclude = 3 }]"));
}

TEST_F(ChangedStudy, AValueThatIsNoTomlIsAText) {
  EXPECT_THAT(with("experiment.a.validation=last 30 %"), HasSubstr("validation = \"last 30 %\"\n"));
  EXPECT_THAT(with("curves.C_m.roughness=auto"), HasSubstr("[effects]\n\n[curves]\nC_m.roughness = \"auto\"\n"));
  EXPECT_THAT(with("parameters.k.free=false"), HasSubstr("[parameters]\nk.free = false\n"));
  EXPECT_THAT(with("study.name='a \"b\"'"), HasSubstr("name = 'a \"b\"'  # two\n"));
}

TEST_F(ChangedStudy, AParameterOfAnEffectIsFoundHoweverItIsWritten) {
  const auto free_of = [&](const std::string& entry, const std::string& key) {
    folder.write("study.toml", text + "[parameters]\n" + entry + "\n");
    return with(key + ".free=false").substr(text.size());
  };
  for (const char* key : {"parameters.late.tau", "parameters.\"late.tau\""}) {
    EXPECT_EQ(free_of("\"late.tau\" = { value = 0.3 }", key), "[parameters]\n\"late.tau\" = { value = 0.3, free = false }\n") << key;
    EXPECT_EQ(free_of("late.tau.free = true", key), "[parameters]\nlate.tau.free = false\n") << key;
    EXPECT_EQ(free_of("late.tau = { free = true }", key), "[parameters]\nlate.tau = { free = false }\n") << key;
  }
}

TEST_F(ChangedStudy, WhatIsNoSettingIsRefusedWithItsWords) {
  for (const char* words : {"", "=", "a", "a=", "=1", "\"a=1"}) EXPECT_THROW((void)read_setting(words), InputError) << words;
  for (const char* key : {"a b", "parameters..k", ".k", "k", "[parameters].k", "a = 1\nb"})
    EXPECT_THAT([&] { (void)with(std::string(key) + "=1"); }, ThrowsMessage<InputError>(HasSubstr("parameters.k.free"))) << key;
}

const Registry& all_effects() {
  static const Registry all = [] {
    Registry r;
    misfit_models_register(r);
    return r;
  }();
  return all;
}

/// The lines of what is wrong.
std::vector<int> lines_of(const std::vector<TextFault>& faults) {
  std::vector<int> out;
  for (const TextFault& fault : faults) out.push_back(fault.line);
  return out;
}

TEST_F(ChangedStudy, EveryFaultIsSaidNotOnlyTheFirst) {
  const auto faults = [&](const std::string& study) { return faults_of(folder.path() / "study.toml", study, all_effects()); };
  const std::string good =
      "[study]\nname = \"two\"\nseed = 1\n[system]\nkind = \"lti\"\n[[experiment]]\ndata = \"a.csv\"\nexclude = [0.2, 0.3]\n[effects]\n";
  std::string bad = good;
  const auto change = [&](const std::string& from, const std::string& to) { bad.replace(bad.find(from), from.size(), to); };
  change("seed", "seeds");
  change("exclude = [0.2, 0.3]", "exclude = \"some\"");
  change("data = \"a.csv\"", "data = \"a.csv\"\nvalidaton = \"last 25 %\"");
  const std::vector<TextFault> found = faults(bad);
  EXPECT_THAT(lines_of(found), testing::IsSupersetOf({3, 8, 9})) << "seeds, validaton, exclude";
  EXPECT_EQ(found.front().message, fault_of(folder.path() / "study.toml", bad, all_effects())->message) << "the first is what a run says";

  bad = good;
  change("data = \"a.csv\"", "data = \"none.csv\"");
  for (const TextFault& fault : faults(bad)) EXPECT_THAT(fault.message, testing::Not(HasSubstr("is needed"))) << "not what follows only";
  EXPECT_EQ(lines_of(faults("[study]\nname = = 1\nseeds = 1\n")), (std::vector<int>{2, 3, 0}))
      << "what is no TOML, an unknown key, and [system], which is missing";
  EXPECT_EQ(lines_of(faults("")), (std::vector<int>{0}));
}

}  // namespace
}  // namespace misfit
