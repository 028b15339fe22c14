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

}  // namespace
}  // namespace misfit
