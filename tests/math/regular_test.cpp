#include "misfit/math/regular.h"

#include <gtest/gtest.h>

namespace misfit {
namespace {

TEST(Outside, IsWhatLiesBeyondEitherEnd) {
  EXPECT_DOUBLE_EQ(outside(10.5, 0.5, 10.0), 0.5);
  EXPECT_DOUBLE_EQ(outside(-2.0, 0.5, 10.0), -2.5);
  EXPECT_DOUBLE_EQ(outside(3.0, 0.5, 10.0), 0.0);
  EXPECT_DOUBLE_EQ(outside(-2.0, -1.5, 1.5), beyond(-2.0, 1.5));
  EXPECT_DOUBLE_EQ(outside(2.0, -1.5, 1.5), beyond(2.0, 1.5));
}

TEST(Wave, GoesFromTheCosineToTheSine) {
  EXPECT_NEAR(wave(0.0, 3.0, 5.0), 3.0, 1e-14);
  EXPECT_NEAR(wave(0.25, 3.0, 5.0), 5.0, 1e-14);
  EXPECT_NEAR(wave(-1.0 / 6.0, 3.0, 5.0), 1.5 - 5.0 * 0.86602540378443865, 1e-14) << "-60 deg";
}

}  // namespace
}  // namespace misfit
