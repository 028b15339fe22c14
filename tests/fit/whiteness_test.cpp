#include "misfit/fit/whiteness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace misfit {
namespace {

std::vector<double> autoregressive(std::size_t n, double memory, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<double> r(n);
  double last = normal(generator) / std::sqrt(1.0 - memory * memory);
  for (double& x : r) x = last = memory * last + normal(generator);
  return r;
}

TEST(Autocorrelation, OfAnAlternatingSequenceIsAlternating) {
  std::vector<double> r(1000);
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = i % 2 == 0 ? 1.0 : -1.0;
  const auto rho = autocorrelation(r, 3);
  ASSERT_EQ(rho.size(), 4U);
  EXPECT_DOUBLE_EQ(rho[0], 1.0);
  EXPECT_NEAR(rho[1], -1.0, 1e-12);
  EXPECT_NEAR(rho[2], 1.0, 1e-12);
}

TEST(Autocorrelation, OfAnAutoregressionFallsGeometrically) {
  const auto rho = autocorrelation(autoregressive(200000, 0.8, 1), 5);
  for (int lag = 0; lag <= 5; ++lag) EXPECT_NEAR(rho[static_cast<std::size_t>(lag)], std::pow(0.8, lag), 0.01);
}

TEST(Autocorrelation, LeavesOutMissingPairsAndTheMean) {
  auto r = autoregressive(50000, 0.6, 2);
  for (double& x : r) x += 100.0;
  for (std::size_t i = 0; i < r.size(); i += 7) r[i] = std::numeric_limits<double>::quiet_NaN();
  const auto rho = autocorrelation(r, 2);
  EXPECT_NEAR(rho[1], 0.6, 0.02);
  EXPECT_NEAR(rho[2], 0.36, 0.02);
}

TEST(Autocorrelation, OfFewerThanTenPairsIsNotGiven) {
  const auto rho = autocorrelation({1.0, 2.0, 1.5, 0.5, 2.5, 1.0, 2.0, 1.5, 0.5, 2.5, 1.0}, 2);
  EXPECT_TRUE(std::isfinite(rho[1]));
  EXPECT_TRUE(std::isnan(rho[2]));
}

TEST(Whiteness, WhiteNoiseFailsAtTheNominalRate) {
  int below_5_percent = 0, below_half = 0, driven = 0;
  constexpr int seeds = 200;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const WhitenessTest test = whiteness(autoregressive(2000, 0.0, seed), 5, 17);
    below_5_percent += test.p_value < 0.05 ? 1 : 0;
    below_half += test.p_value < 0.5 ? 1 : 0;
    driven += looks_driven(test) ? 1 : 0;
  }
  EXPECT_NEAR(below_5_percent, 0.05 * seeds, 3.0 * std::sqrt(0.05 * 0.95 * seeds));  // binomial, 3 sigma
  EXPECT_NEAR(below_half, 0.5 * seeds, 3.0 * std::sqrt(0.25 * seeds));
  EXPECT_EQ(driven, 0);
}

TEST(Whiteness, MemoryBeyondTheFirstLagFails) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const WhitenessTest test = whiteness(autoregressive(2000, 0.8, seed), 5, 17);
    EXPECT_LT(test.p_value, 1e-6);
    EXPECT_EQ(test.largest_lag, 5);
    EXPECT_NEAR(test.largest, std::pow(0.8, 5), 0.15);
    EXPECT_TRUE(looks_driven(test));
  }
}

TEST(Whiteness, NoiseThroughAFivePointStencilHasNoMemoryBeyondItsReach) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const auto e = autoregressive(2004, 0.0, seed);
    std::vector<double> r;
    for (std::size_t i = 2; i + 2 < e.size(); ++i) r.push_back(-e[i - 2] + 16 * e[i - 1] - 30 * e[i] + 16 * e[i + 1] - e[i + 2]);
    EXPECT_TRUE(looks_driven(whiteness(r, 1, 17)));
    const WhitenessTest beyond = whiteness(r, 5, 17);
    EXPECT_FALSE(looks_driven(beyond));
    EXPECT_LT(std::abs(beyond.largest),
              0.12);  // 3.7 of the scatter sqrt(sum of rho^2/n) = 0.032 that coloured noise has (Bartlett), not 1/sqrt(n)
  }
}

TEST(Whiteness, WeakMemoryIsSignificantButNotDriven) {
  const WhitenessTest test = whiteness(autoregressive(100000, 0.5, 3), 5, 10);
  EXPECT_LT(test.p_value, 1e-6);
  EXPECT_LT(std::abs(test.largest), 0.15);
  EXPECT_FALSE(looks_driven(test));
}

TEST(Whiteness, StatisticIsThatOfLjungAndBox) {
  const std::vector<double> r = autoregressive(60, 0.4, 5);
  const auto rho = autocorrelation(r, 3);
  const WhitenessTest test = whiteness(r, 2, 3);
  EXPECT_NEAR(test.statistic, 60.0 * 62.0 * (rho[2] * rho[2] / 58.0 + rho[3] * rho[3] / 57.0), 1e-12);
  EXPECT_NEAR(test.p_value, std::exp(-test.statistic / 2.0), 1e-12);  // chi² with two degrees of freedom
}

}  // namespace
}  // namespace misfit
