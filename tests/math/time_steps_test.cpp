#include "misfit/math/time_steps.h"

#include <gtest/gtest.h>

namespace misfit {
namespace {

TEST(LongSteps, AreGapsWhereTheyAreFew) {
  std::vector<double> steps(100, 0.1);
  steps[3] = 0.14;
  steps[20] = steps[21] = 0.16;
  steps[50] = 5.0;
  const LongSteps gaps = long_steps(steps);
  EXPECT_EQ(gaps.usual, 0.1);
  EXPECT_EQ(gaps.longest, 5.0);
  EXPECT_EQ(gaps.count, 3U);
  EXPECT_FALSE(gaps.uneven);
}

TEST(LongSteps, AreNoGapsWhereEveryFourthIsOne) {
  std::vector<double> steps;
  for (int k = 0; k < 100; ++k) steps.push_back(k % 4 == 0 ? 5.5e-3 : 3.5e-3);
  const LongSteps clock = long_steps(steps);
  EXPECT_TRUE(clock.uneven);
  EXPECT_EQ(clock.usual, 3.5e-3);
  EXPECT_EQ(clock.longest, 5.5e-3);
}

TEST(LongSteps, OfNoneAreNone) { EXPECT_EQ(long_steps({}).count, 0U); }

}  // namespace
}  // namespace misfit
