#include "misfit/math/counter_random.h"

#include <gtest/gtest.h>

namespace misfit {
namespace {

TEST(CounterRandom, IsTheSameForTheSameAddressOnly) {
  EXPECT_EQ(random_normal(1, 2, 3), random_normal(1, 2, 3));
  EXPECT_NE(random_normal(1, 2, 3), random_normal(2, 2, 3));
  EXPECT_NE(random_normal(1, 2, 3), random_normal(1, 3, 3));
  EXPECT_NE(random_normal(1, 2, 3), random_normal(1, 2, 4));
  EXPECT_NE(random_normal(1, 2, 3), random_normal(1, 2, 3, 1));
}

/// Moments over neighbouring jobs, streams and seeds: within four standard errors of 100 000 draws.
TEST(CounterRandom, NeighboursLookIndependentAndNormal) {
  constexpr double n = 100000.0;
  for (const int along : {0, 1, 2}) {
    double sum = 0.0, squares = 0.0, fourth = 0.0, product = 0.0, before = 0.0;
    for (std::uint64_t k = 0; k < 100000; ++k) {
      const double z = along == 0 ? random_normal(1, k, 5) : along == 1 ? random_normal(1, 5, k) : random_normal(k, 1, 5);
      sum += z;
      squares += z * z;
      fourth += z * z * z * z;
      product += z * before;
      before = z;
    }
    EXPECT_NEAR(sum / n, 0.0, 4.0 / std::sqrt(n));
    EXPECT_NEAR(squares / n, 1.0, 4.0 * std::sqrt(2.0 / n));
    EXPECT_NEAR(fourth / n, 3.0, 4.0 * std::sqrt(96.0 / n));
    EXPECT_NEAR(product / n, 0.0, 4.0 / std::sqrt(n));
  }
}

TEST(CounterRandom, UniformStaysInside) {
  double lowest = 1.0, highest = 0.0;
  for (std::uint64_t k = 0; k < 100000; ++k) {
    lowest = std::min(lowest, random_uniform(1, k, 0));
    highest = std::max(highest, random_uniform(1, k, 0));
  }
  EXPECT_GT(lowest, 0.0);
  EXPECT_LT(lowest, 1e-4);
  EXPECT_LT(highest, 1.0);
  EXPECT_GT(highest, 1.0 - 1e-4);
}

}  // namespace
}  // namespace misfit
