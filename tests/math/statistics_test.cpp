#include "misfit/math/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace misfit {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

TEST(Resolution, IsTheStepOfWhichAllDifferencesAreMultiples) {
  EXPECT_NEAR(resolution_of({0.3, 0.55, 0.3, 1.05, -0.2}), 0.25, 1e-12);
  EXPECT_EQ(resolution_of({0.3, 0.55, 0.3, 1.0, -0.2}), 0.0) << "1.0 is off by a fifth";
  EXPECT_EQ(resolution_of({1.0, 2.0, 2.0}), 0.0) << "two values have no step";
  EXPECT_EQ(resolution_of({1.0, 1.0 + 1e-12, 1.0 + 2e-12, 1.0 + 3e-12, 1.0 + 4e-12}), 0.0) << "nor has what differs by rounding";
}

/// Multiples of a step that is no short decimal number: what printing cuts off must not add up over thousands of steps.
TEST(Resolution, OfAnEncoderPrintedWithSevenDecimals) {
  constexpr double step = 2.0 * std::numbers::pi / 4096.0;
  std::vector<double> angles;
  for (int k = -2000; k <= 2000; k += k % 7 == 0 ? 1 : 3) angles.push_back(1e-7 * std::round(1e7 * step * k));
  EXPECT_NEAR(resolution_of(angles), step, 1e-6 * step);
  angles.push_back(step * 17.1);
  EXPECT_EQ(resolution_of(angles), 0.0) << "a tenth of a step off";
}

TEST(Statistics, MedianOfOddEvenAndMissing) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_EQ(median({missing, 5.0, 1.0, missing, 2.0}), 2.0);
  EXPECT_TRUE(std::isnan(median({})));
  EXPECT_TRUE(std::isnan(median({missing})));
}

TEST(Statistics, RobustSigmaIsThatOfTheGoodPartAlthoughAFifthIsWild) {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal(3.0, 0.5);
  std::vector<double> values;
  for (int i = 0; i < 4000; ++i) values.push_back(normal(generator));
  EXPECT_NEAR(mad_sigma(values), 0.5, 0.03);  // sampling error of the MAD: 1.17 sigma / sqrt(n) = 0.009
  for (std::size_t i = 0; i < 800; ++i) values[5 * i] = 1000.0;
  EXPECT_NEAR(mad_sigma(values), 0.5, 0.2);  // shrinks the usable half: known bias of a fifth of wild values is + 30 %
}

TEST(Statistics, ChiSquareTailAgainstTables) {
  EXPECT_NEAR(chi_square_tail(3.841458820694124, 1), 0.05, 1e-12);
  EXPECT_NEAR(chi_square_tail(18.307038053275146, 10), 0.05, 1e-12);
  EXPECT_NEAR(chi_square_tail(1000.0, 2) / std::exp(-500.0), 1.0, 1e-9);
  EXPECT_EQ(chi_square_tail(0.0, 3), 1.0);
  EXPECT_EQ(chi_square_tail(-1.0, 3), 1.0);
  EXPECT_TRUE(std::isnan(chi_square_tail(missing, 3)));
}

TEST(Statistics, FTailAgainstTablesAndItsChiSquareLimit) {
  EXPECT_NEAR(f_tail(4.964602743730711, 1, 10), 0.05, 1e-10);
  EXPECT_NEAR(f_tail(2.6, 3, 1e9), chi_square_tail(7.8, 3), 1e-7);
  EXPECT_EQ(f_tail(0.0, 2, 5), 1.0);
}

TEST(Statistics, StudentQuantilesAreThoseOfTheTables) {
  EXPECT_NEAR(student_quantile(0.975, 1.0), 12.706, 5e-4);
  EXPECT_NEAR(student_quantile(0.975, 3.0), 3.182, 5e-4);
  EXPECT_NEAR(student_quantile(0.975, 10.0), 2.228, 5e-4);
  EXPECT_NEAR(student_quantile(0.975, 1e7), normal_quantile(0.975), 1e-6);
}

TEST(Statistics, NormalQuantileAndTailAreInverse) {
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
  for (const double p : {1e-12, 1e-3, 0.4}) EXPECT_NEAR(normal_tail(normal_quantile(1.0 - p)) / p, 1.0, 1e-3);
  EXPECT_NEAR(normal_tail(0.0), 0.5, 1e-15);
}

TEST(Statistics, SidakOfTinyAndLargeProbabilities) {
  EXPECT_NEAR(sidak(0.01, 5), 1.0 - std::pow(0.99, 5), 1e-15);
  EXPECT_NEAR(sidak(1e-200, 5) / 5e-200, 1.0, 1e-12);
  EXPECT_EQ(sidak(1.0, 5), 1.0);
  EXPECT_EQ(sidak(0.0, 5), 0.0);
}

TEST(StandardDeviation, IsThatOfTheFiniteValuesAboutTheirMean) {
  EXPECT_NEAR(standard_deviation({2.0, 4.0, missing, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}), 2.0, 1e-12) << "mean 5, squares 32 over 8";
  EXPECT_EQ(standard_deviation({3.0, missing}), 0.0);
  EXPECT_EQ(standard_deviation({}), 0.0);
}

TEST(StandardDeviation, OfSmallChangesOfALargeLevelIsThatOfTheChanges) {
  EXPECT_NEAR(standard_deviation({1e9 + 1.0, 1e9 - 1.0, 1e9 + 1.0, 1e9 - 1.0}), 1.0, 1e-12);
}

TEST(MeanAndSigma, AConstantIsOneThoughItsMeanIsRounded) {
  EXPECT_TRUE(mean_and_sigma(std::vector<double>(1001, 0.1)).constant());
  EXPECT_TRUE(mean_and_sigma({missing}).constant());
  EXPECT_FALSE(mean_and_sigma({1.0, 1.0 + 1e-9}).constant());
  EXPECT_FALSE(mean_and_sigma({-1e-30, 1e-30}).constant()) << "a mean of 0 rounds nothing";
}

}  // namespace
}  // namespace misfit
