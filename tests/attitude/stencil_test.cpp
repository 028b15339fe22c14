#include "misfit/attitude/stencil.h"

#include <gtest/gtest.h>

#include <cmath>

namespace misfit {
namespace {

TEST(Stencil, EvenTimesGiveThePapersFourPointWeights) {
  const auto w = derivative_weights({0.0, 0.5, 1.0, 1.5, 2.0}, 2);
  const double h = 0.5;
  EXPECT_NEAR(w[0], 1.0 / (12.0 * h), 1e-15);
  EXPECT_NEAR(w[1], -8.0 / (12.0 * h), 1e-14);
  EXPECT_NEAR(w[2], 0.0, 1e-14);
  EXPECT_NEAR(w[3], 8.0 / (12.0 * h), 1e-14);
  EXPECT_NEAR(w[4], -1.0 / (12.0 * h), 1e-15);
}

TEST(Stencil, QuarticsAreExactOnUnevenTimes) {
  const std::vector<double> t = {0.0, 0.11, 0.2, 0.32, 0.4};
  std::vector<double> f;
  for (const double x : t) f.push_back(1.0 + 2.0 * x - 3.0 * x * x + 4.0 * x * x * x - 5.0 * x * x * x * x);
  const auto w = derivative_weights(t, 2);
  double slope = 0.0;
  for (std::size_t k = 0; k < 5; ++k) slope += w[k] * f[k];
  EXPECT_NEAR(slope, 2.0 - 6.0 * 0.2 + 12.0 * 0.04 - 20.0 * 0.008, 1e-13);
}

TEST(Stencil, StepsAreJudgedByTheUsualOne) {
  const auto even = even_steps({0.0, 1.0, 2.0, 3.19, 4.5, 5.5, 6.5, 8.5}, 0.2);
  EXPECT_EQ(even, (std::vector<bool>{true, true, true, false, true, true, false}));
  EXPECT_TRUE(even_steps({}, 0.2).empty());
  EXPECT_TRUE(even_steps({1.0}, 0.2).empty());
}

}  // namespace
}  // namespace misfit
