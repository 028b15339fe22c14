#include "misfit/show/extreme_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace misfit {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(ExtremeRows, AreThoseWhereAnyListIsLeastOrLargestAndWhereItsGapsBeginAndEnd) {
  const std::vector<double> a = {0, 5, 1, 1, 1, -5, 1, 1, 1, nan, nan, nan, 1, 1, 1, 2}, b(16, 0.0);
  EXPECT_THAT(extreme_rows({&a}, 4), testing::ElementsAre(1, 5, 8, 9, 11, 15));
  EXPECT_THAT(extreme_rows({&a, &b}, 8), testing::ElementsAre(0, 1, 5, 8, 9, 11, 15));
}

TEST(ExtremeRows, AreAllWhereTheyAreFewEnough) {
  const std::vector<double> a = {0, 5, nan};
  EXPECT_THAT(extreme_rows({&a}, 3), testing::ElementsAre(0, 1, 2));
  EXPECT_THAT(extreme_rows({}, 3), testing::IsEmpty());
}

}  // namespace
}  // namespace misfit
