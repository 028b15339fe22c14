// misfit set: values of a study from the command line.
#include <gmock/gmock.h>

#include "tests/apps/oscillator_study.h"

namespace {

using namespace program;
using testing::HasSubstr;

class Setting : public testing::Test {
 protected:
  [[nodiscard]] Outcome set(const std::vector<std::string>& words) const {
    std::vector<std::string> all{"set", study.path("study.toml").string()};
    all.insert(all.end(), words.begin(), words.end());
    return program::run(all);
  }
  [[nodiscard]] std::string text() const { return content(study.path("study.toml")); }

  OscillatorStudy study;
  const std::string before = text();
};

TEST_F(Setting, AParameterIsHeldAndAnotherPartHeldOut) {
  const Outcome outcome = set({"parameters.k.free=false", "parameters.k.value=4.5", "experiment.steps.validation=[2, 4]"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("parameters.k.free = false\nparameters.k.value = 4.5\n"));
  EXPECT_THAT(text(), HasSubstr("\n[parameters]\nk.free = false\nk.value = 4.5\n"));
  EXPECT_THAT(text(), HasSubstr("data = \"d.csv\"\nvalidation = [2, 4]\n[effects]\n"));
  const Outcome fit = program::run({"fit", study.path("study.toml").string(), "--method", "output_error"});
  ASSERT_EQ(fit.status, 0) << fit.err;
  const json parameters = json::parse(content(study.path("out/fit/output_error/fit.json"))).at("parameters");
  EXPECT_FALSE(parameters.contains("k"));
  EXPECT_TRUE(parameters.contains("c"));
}

TEST_F(Setting, WhatTheStudyDoesNotAllowLeavesItAsItIs) {
  const std::vector<std::pair<std::string, std::string>> wrong{{"parameters.kk.free=false", "did you mean 'k'"},
                                                               {"parameters.k.free=maybe", "free"},
                                                               {"parameters.k.fre=true", "did you mean 'free'"},
                                                               {"experiment.step.validation=[1, 2]", "did you mean 'steps'"},
                                                               {"experiment.steps.validation=[2, 1]", "the first before the second"},
                                                               {"study.seed=-1", "seed"},
                                                               {"study.methods=output_error", "methods"},
                                                               {"system.file=no.toml", "no.toml"},
                                                               {"study=1", "parameters.k.free"},
                                                               {"study.seed", "KEY=VALUE"}};
  for (const auto& [words, says] : wrong) {
    const Outcome outcome = set({words});
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_THAT(outcome.err, HasSubstr(says)) << words;
    EXPECT_EQ(text(), before) << words;
  }
  EXPECT_EQ(set({"parameters.k.free=false", "parameters.kk.free=false"}).status, 2) << "all or nothing";
  EXPECT_EQ(text(), before);
}

TEST_F(Setting, ALinkIsNotWrittenThrough) {
  fs::create_symlink(study.path("study.toml"), study.path("link.toml"));
  const Outcome outcome = program::run({"set", study.path("link.toml").string(), "study.seed=2"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("is a link"));
  EXPECT_EQ(text(), before);
}

}  // namespace
