#include "misfit/math/whiteness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

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
  EXPECT_NEAR(rho[1], -0.999, 1e-12);  // 999 pairs of 1000 values
  EXPECT_NEAR(rho[2], 0.998, 1e-12);
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

/// Pairs of lag 4 and more lie in the loud part alone: the variance of all values is a tenth of theirs.
TEST(Autocorrelation, IsAtMostOneWhereOnlyALoudPartHasPairs) {
  std::vector<double> r;
  for (int i = 0; i < 60; ++i) r.push_back(10.0 * std::sin(0.05 * i));
  for (int part = 0; part < 200; ++part) {
    r.insert(r.end(), 40, std::numeric_limits<double>::quiet_NaN());
    for (int i = 0; i < 4; ++i) r.push_back(i % 2 == 0 ? 0.1 : -0.1);
  }
  const auto rho = autocorrelation(r, 20);
  for (const double value : rho) EXPECT_LE(std::abs(value), 1.0);
  EXPECT_GT(rho[4], 0.9);
  EXPECT_LE(std::abs(whiteness(r, 4, 20).largest), 1.0);
}

TEST(Autocorrelation, IsAtMostOneWhateverIsMissing) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform;
    std::vector<double> r = autoregressive(300, 0.99, seed);
    for (double& x : r) x = uniform(random) < 0.6 ? std::numeric_limits<double>::quiet_NaN() : x * std::exp(3.0 * uniform(random));
    for (const double value : autocorrelation(r, 60)) EXPECT_FALSE(std::abs(value) > 1.0);
  }
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
  EXPECT_NEAR(test.p_value, std::exp(-test.statistic / 2.0), 0.02);  // chi² with two degrees of freedom, all but for what the lags share
}

/// How many of 1000 white series of n values (each `missing`, with blocks of 10 instead of single values if `blocks`) are below p.
struct Alarms {
  int at_5_percent = 0, at_1_percent = 0;
};

Alarms alarms(std::size_t n, int lags, double missing = 0.0, bool blocks = false) {
  Alarms out;
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    std::vector<double> r = autoregressive(n, 0.0, seed + 1000U * static_cast<unsigned>(n) + static_cast<unsigned>(lags));
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform;
    const std::size_t block = blocks ? 10 : 1;
    for (std::size_t i = 0; i < n; i += block) {
      if (uniform(random) >= missing) continue;
      for (std::size_t k = i; k < std::min(n, i + block); ++k) r[k] = std::numeric_limits<double>::quiet_NaN();
    }
    const double p = whiteness(r, 1, lags).p_value;
    out.at_5_percent += p < 0.05 ? 1 : 0;
    out.at_1_percent += p < 0.01 ? 1 : 0;
  }
  return out;
}

void expect_nominal(const Alarms& found, const std::string& what) {
  const auto within = [&](int count, double rate) {
    const double expected = 1000.0 * rate, spread = 3.3 * std::sqrt(1000.0 * rate * (1.0 - rate));  // once in 1000 by chance
    EXPECT_NEAR(count, expected, spread) << what << ", p < " << rate;
  };
  within(found.at_5_percent, 0.05);
  within(found.at_1_percent, 0.01);
}

TEST(Whiteness, AlarmsAtTheNominalRateForAllLengthsAndLags) {
  for (const std::size_t n : {20U, 30U, 50U, 100U, 200U, 500U, 2000U, 20000U}) {
    for (const int lags : {1, 3, 10, 40}) {
      if (n == 20000U && lags > 10) continue;  // of the same kind as 2000, and ten times as long to compute
      expect_nominal(alarms(n, lags), std::to_string(n) + " values, " + std::to_string(lags) + " lags");
    }
  }
}

TEST(Whiteness, AlarmsAtTheNominalRateWhereValuesAreMissing) {
  for (const std::size_t n : {50U, 200U, 1000U}) {
    expect_nominal(alarms(n, 10, 0.3), std::to_string(n) + " values, single ones missing");
    expect_nominal(alarms(n, 10, 0.4, true), std::to_string(n) + " values, blocks missing");
  }
}

TEST(Whiteness, MoreLagsThanAQuarterOfTheValuesAreNotLookedAt) {
  EXPECT_EQ(whiteness(autoregressive(40, 0.0, 1), 1, 3000).last_lag, 10);
  EXPECT_EQ(whiteness(autoregressive(2500, 0.0, 1), 1, 3000).last_lag, 110);
  const WhitenessTest none = whiteness(autoregressive(12, 0.9, 1), 5, 17);
  EXPECT_EQ(none.p_value, 1.0);
  EXPECT_LT(none.last_lag, none.first_lag);
  EXPECT_NE(in_words(none).find("too few"), std::string::npos);
}

TEST(Whiteness, SaysNothingOfResidualsOfNearlyAsManyUnknowns) {
  const std::vector<double> r = autoregressive(39, 0.9, 1);
  EXPECT_LT(whiteness(r, 1, 10, 3.0).p_value, 0.01);
  EXPECT_EQ(whiteness(r, 1, 10, 4.0).p_value, 1.0);
}

TEST(Whiteness, ColouredShortSeriesAlarm) {
  int alarms = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) alarms += whiteness(autoregressive(50, 0.7, seed), 1, 100).p_value < 0.05 ? 1 : 0;
  EXPECT_GT(alarms, 90);
}

/// By hand: 1 … 12 has c_k = (1/n) Σ (i − 6.5)(i + k − 6.5).
TEST(Autocorrelation, IsTheTextbookOneOfAStraightLine) {
  std::vector<double> r(12);
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = static_cast<double>(i + 1);
  const auto rho = autocorrelation(r, 2);
  EXPECT_NEAR(rho[1], 0.75, 1e-12);          // 107.25/143
  EXPECT_NEAR(rho[2], 72.5 / 143.0, 1e-12);  // 10 pairs
}

TEST(EvenGrid, TimeWithoutSamplesIsNoNeighbour) {
  std::vector<double> t, r;
  for (int i = 0; i < 40; ++i) {
    t.push_back(0.1 * i + (i >= 20 ? 3600.0 : 0.0));
    r.push_back(i);
  }
  t[30] += 0.004;  // not to the digit
  const std::vector<double> even = on_even_grid(t, r);
  EXPECT_EQ(even.size(), 80U);  // as many places as there are values stand for the hour
  EXPECT_EQ(even[19], 19.0);
  EXPECT_TRUE(std::isnan(even[20]));
  EXPECT_EQ(even[60], 20.0);
}

/// Two constants, one after the other: every pair of lag 1 within a series is alike, and none lies across.
TEST(JoinedSeries, PairsDoNotLieAcross) {
  const std::vector<double> low(15, -1.0), high(15, 1.0);
  const std::vector<double> joined = joined_series({low, high});
  EXPECT_EQ(joined.size(), 60U);
  EXPECT_GT(autocorrelation(joined, 1)[1], 0.95);
}

}  // namespace
}  // namespace misfit
