// A model that is known: nothing to estimate but noise and random force. What does it lack?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/workflow/swing.h"
#include "tests/workflow/text_study.h"

namespace {

using namespace misfit;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing_text_study::TextStudy;

/// With `from` replaced by `to`.
std::string changed(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

/// The swing with all its parameters at their true values, fixed.
std::string known_swing(const std::string& stiffness = "40.0") {
  std::string text = changed(testing_swing::system(), "value = 30.0, bounds = [1.0, 400.0], free = true", "value = " + stiffness);
  text = changed(text, "value = 0.5, bounds = [0.0, 40.0], free = true", "value = 0.8");
  return changed(text, "value = 20.0, free = true", "value = 25.0");
}

TEST(AKnownModel, HasItsNoiseEstimatedAndSaysThatNothingElseIs) {
  TextStudy study(known_swing(), testing_swing::recording(1));
  const Fit fit = study.fit("filter_error", "");
  EXPECT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_NEAR(fit.noise.at("x").value, 0.004, 4.0 * fit.noise.at("x").sigma);
  EXPECT_THAT(fit.warnings, Contains(HasSubstr("every parameter is fixed")));
  EXPECT_EQ(study.fit("output_error", "").status, FitStatus::declined);
}

TEST(AKnownModel, LacksNothingWhereItIsRight) {
  TextStudy study(known_swing(), testing_swing::recording(2));
  Identification identification = study.identification("filter_error", "");
  const Discovery found = identification.discover();
  EXPECT_FALSE(identification.accepted(found));
  EXPECT_FALSE(found.fixed_parameters);
}

/// No effect of the library is a stiffness alone, which a user would free in the system: what is found is one that has a stiffness.
TEST(AKnownModel, LacksAForceInProportionWhereItsStiffnessIsTooLow) {
  TextStudy study(known_swing("39.0"), testing_swing::recording(3));
  Identification identification = study.identification("filter_error", "");
  const Discovery found = identification.discover();
  ASSERT_TRUE(identification.accepted(found)) << found.verdict;
  const Candidate& first = found.candidates.front();
  ASSERT_EQ(first.effect, "dead_zone") << found.verdict;
  EXPECT_NEAR(first.parameters.at("stop_stiffness").value, 1.0, 4.0 * first.parameters.at("stop_stiffness").sigma);
  EXPECT_LT(first.parameters.at("half_width").value, 0.02) << "a dead zone of no width";
  ASSERT_TRUE(found.fixed_parameters) << "what a user would free";
  ASSERT_EQ(found.fixed_parameters->size(), 1U);
  EXPECT_THAT(found.fixed_parameters->front(),
              AllOf(HasSubstr("k is fixed at 39 1/s^2, but these data ask for 39.99"), HasSubstr("(drop 39")));
}

/// A random force that is hardly there has no correlation time: its logarithm is held, and the sigma of what is held is none.
TEST(TheCorrelationTimeOfARandomForce, HasNoSigmaWhereTheForceIsHardlyThere) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    TextStudy study(known_swing(), testing_swing::recording(seed));
    const Estimate time = study.fit("filter_error", "").force.at("correlation_time");
    constexpr double least = 0.01;  // of what fifteen seconds can tell
    EXPECT_TRUE(time.sigma == 0.0 || time.sigma > least * time.value) << time.value << " ± " << time.sigma;
    if (time.interval) {
      EXPECT_GT(time.interval->second, (1.0 + least) * time.interval->first);
    }
  }
}

}  // namespace
