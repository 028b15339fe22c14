// Estimates depend on the measurements, not on the unit in which a parameter happens to be counted.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/fit/room.h"

namespace misfit {
namespace {

using namespace testing_room;

TEST(SizeOfAParameter, ChangesNoEstimate) {
  const FilterEstimate seconds = estimate_of(warming("tau", "2e4"));
  const FilterEstimate counted = estimate_of(warming("1e4 * tau", "2.0"));
  const double sigma = std::sqrt(seconds.covariance(0, 0)), tau = seconds.model.theta()[0];
  EXPECT_NEAR(tau, true_tau, 3.0 * sigma);
  EXPECT_GT(sigma, 100.0) << "1000 typical sizes of 1 s are only a few of these";
  EXPECT_NEAR(tau, 1e4 * counted.model.theta()[0], 0.05 * sigma);
  EXPECT_NEAR(sigma, 1e4 * std::sqrt(counted.covariance(0, 0)), 0.01 * sigma);
  EXPECT_NEAR(seconds.objective, counted.objective, 0.01);
}

}  // namespace
}  // namespace misfit
