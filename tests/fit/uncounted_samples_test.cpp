// Samples before `exclude` and outputs that no sample counts of, in output error.
#include <gtest/gtest.h>

#include "tests/fit/first_order.h"

namespace misfit {
namespace {

using namespace testing_first_order;

TEST(UncountedSamples, OfTheFirstOutputAloneLeaveTheFitToTheOther) {
  Signals both = record("both", 1.0, 2, 0.5, 2);
  both.exclude = 20;
  std::fill(both.measured[0].values.begin() + 20, both.measured[0].values.end(), std::nan(""));
  const Fit fit = fitted(two_outputs, {both}).fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_EQ(fit.rms.count("y"), 0U);
  EXPECT_NEAR(fit.rms.at("z").value, noise, 0.1 * noise);
  EXPECT_NE(fit.facts.at("explained").find("residual RMS"), std::string::npos);
}

/// While the recorder starts, it shows something else than the motion.
TEST(UncountedSamples, OfTheBeginningAreNotInTheTestOfWhiteness) {
  Signals s = record("e", 1.0, 2);
  s.exclude = 60;
  for (std::size_t i = 0; i < s.exclude; ++i) s.measured[0].values[i] += 0.2 * std::sin(0.8 * s.t[i]);
  const Fit fit = fitted(one_output, {s}).fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_FALSE(fit.coloured) << fit.facts.at("whiteness");
  EXPECT_FALSE(fit.driven);
  Signals without = s;
  for (std::size_t i = 0; i < s.exclude; ++i) without.measured[0].values[i] = std::nan("");
  EXPECT_EQ(fit.facts.at("whiteness"), fitted(one_output, {without}).fit.facts.at("whiteness"));
}

}  // namespace
}  // namespace misfit
