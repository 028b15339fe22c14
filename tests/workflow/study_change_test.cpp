#include "misfit/workflow/session/study_change.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST_F(ChangedStudy, AValueThatIsNoTomlIsAText) {
  EXPECT_THAT(with("experiment.a.validation=last 30 %"), HasSubstr("validation = \"last 30 %\"\n"));
  EXPECT_THAT(with("curves.C_m.roughness=auto"), HasSubstr("[effects]\n\n[curves]\nC_m.roughness = \"auto\"\n"));
  EXPECT_THAT(with("parameters.k.free=false"), HasSubstr("[parameters]\nk.free = false\n"));
  EXPECT_THAT(with("study.name='a \"b\"'"), HasSubstr("name = 'a \"b\"'  # two\n"));
}

TEST_F(ChangedStudy, WhatIsNoSettingIsRefusedWithItsWords) {
  for (const char* words : {"", "=", "a", "a=", "=1", "\"a=1"}) EXPECT_THROW((void)read_setting(words), InputError) << words;
  for (const char* key : {"a b", "parameters..k", ".k", "k", "[parameters].k", "a = 1\nb"})
    EXPECT_THAT([&] { (void)with(std::string(key) + "=1"); }, ThrowsMessage<InputError>(HasSubstr("parameters.k.free"))) << key;
}

}  // namespace
}  // namespace misfit
