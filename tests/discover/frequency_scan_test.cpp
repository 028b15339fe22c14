#include "misfit/discover/frequency_scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

namespace misfit {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

/// The definition, at one frequency.
double by_definition(const Eigen::VectorXd& x, const SampleTimes& times, double f) {
  std::complex<double> sum;
  Eigen::Index at = 0;
  for (const auto& t : times) {
    for (const double now : t) sum += x[at++] * std::polar(1.0, two_pi * f * now);
  }
  return std::norm(sum);
}

Eigen::VectorXd noise(std::size_t size, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(static_cast<Eigen::Index>(size), [&] { return normal(random); });
}

void expect_as_defined(const SampleTimes& t, double share) {
  std::size_t samples = 0;
  for (const auto& experiment : t) samples += experiment.size();
  const Eigen::VectorXd x = noise(samples, 7);
  const FrequencyGrid grid = frequency_grid(t, 0.2, 12.0, 1);
  ASSERT_GT(grid.count, 100U);
  const std::vector<double> power = periodogram(x, t, grid);
  ASSERT_EQ(power.size(), grid.count);
  double most = 0.0;  // against what a line of noise has on average: sums may cancel
  for (std::size_t f = 0; f < grid.count; ++f)
    most = std::max(most, std::abs(power[f] - by_definition(x, t, grid.at(f))) / (power[f] + x.squaredNorm()));
  EXPECT_LT(most, share);
}

std::vector<double> even(double from, double rate, int samples) {
  std::vector<double> t;
  for (int k = 0; k < samples; ++k) t.push_back(from + k / rate);
  return t;
}

TEST(FrequencyScan, OfEvenSamplesAreTheSum) { expect_as_defined({even(3.0, 59.94, 1500)}, 1e-9); }

TEST(FrequencyScan, OfEvenSamplesWithGapsAreTheSum) {
  std::vector<double> t = even(0.0, 59.94, 1500);
  t.erase(t.begin() + 300, t.begin() + 700);
  for (std::size_t k = 2; k < t.size(); k += 3) t.erase(t.begin() + static_cast<std::ptrdiff_t>(k));
  expect_as_defined({t}, 1e-9);
}

TEST(FrequencyScan, OfUnevenSamplesAreTheSum) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> step(0.01, 0.03);
  std::vector<double> t = {0.0};
  for (int k = 0; k < 1200; ++k) t.push_back(t.back() + step(random));
  expect_as_defined({t}, 1e-9);
}

/// Times of a file with four digits: phases are wrong by up to a hundredth of a radian, which moves |sum|² by as much of |sum| sqrt(Σ λ²).
TEST(FrequencyScan, OfTimesPrintedWithFewDigitsAreNearlyTheSum) {
  std::vector<double> t = even(0.0, 59.94, 1500);
  for (double& v : t) v = std::round(v * 1e4) / 1e4;
  expect_as_defined({t}, 0.01);
}

/// An even one, an uneven one and one at another rate, each with its own origin of time, the last later than all before.
TEST(FrequencyScan, OfSeveralExperimentsAreTheSumOverAll) {
  SampleTimes times = {even(0.0, 59.94, 1500), {0.0}, even(100.0, 25.0, 400)};
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> step(0.01, 0.03);
  for (int k = 0; k < 300; ++k) times[1].push_back(times[1].back() + step(random));
  EXPECT_NEAR(frequency_grid(times, 0.2, 12.0, 1).step, 1.0 / (4.0 * (100.0 + 399.0 / 25.0)), 1e-12) << "half the width of a line in all";
  expect_as_defined(times, 1e-9);
}

/// Ten seconds, and ten more after four minutes: a line is one of fringes that are a quarter of a thousandth of a hertz apart from the
/// next.
TEST(FrequencyScan, OfTwoPartsOfARecordingIsFineEnoughForTheirFringes) {
  const SampleTimes parts = {even(0.0, 50.0, 500), even(250.0, 50.0, 500)};
  constexpr double line = 4.3217;
  Eigen::VectorXd x(1000);
  Eigen::Index at = 0;
  for (const auto& part : parts) {
    for (const double t : part) x[at++] = std::sin(two_pi * line * t);
  }
  const FrequencyGrid grid = frequency_grid(parts, 0.2, 12.0, 1);
  const std::vector<double> power = periodogram(x, parts, grid);
  const auto best = std::max_element(power.begin(), power.end());
  EXPECT_GT(*best, 0.8 * by_definition(x, parts, line));
  EXPECT_NEAR(grid.at(static_cast<std::size_t>(best - power.begin())), line, 1.5 / 250.0);
  EXPECT_NEAR(grid.first, 0.2, 1e-12) << "above half a period in one part";
}

/// Lines are as many as fit in the range: sqrt(12 var t), of one even recording its length, of two short ones far apart more than that.
TEST(FrequencyScan, CountsLinesByHowFarTheSamplesAreSpread) {
  const auto length = [](const SampleTimes& times) { return frequency_grid(times, 0.2, 12.0, 1).even_length; };
  EXPECT_NEAR(length({even(3.0, 50.0, 2001)}), 40.0, 0.05);
  EXPECT_NEAR(length({even(0.0, 50.0, 2001), even(0.0, 50.0, 2001)}), 40.0, 0.05) << "both at the same time";
  EXPECT_NEAR(length({even(0.0, 50.0, 51), even(50.0, 50.0, 51)}), 50.0 * std::sqrt(3.0), 0.1);
  EXPECT_LT(length({even(0.0, 50.0, 51), even(1e9, 50.0, 51)}), 200.0) << "clocks that have nothing to do with each other";
}

TEST(FrequencyScan, StandOutOfTheirBackground) {
  const SampleTimes t = {even(0.0, 50.0, 4000)};
  Eigen::VectorXd x = noise(t[0].size(), 8);
  for (std::size_t k = 0; k < t[0].size(); ++k) x[static_cast<Eigen::Index>(k)] += 0.3 * std::sin(two_pi * 4.321 * t[0][k]);
  const FrequencyGrid grid = frequency_grid(t, 0.2, 30.0, 1);
  std::vector<double> power(grid.count, 0.0);
  add_over_background(periodogram(x, t, grid), power);
  const auto best = static_cast<std::size_t>(std::max_element(power.begin(), power.end()) - power.begin());
  EXPECT_NEAR(grid.at(best), 4.321, grid.step);
  EXPECT_NEAR(grid.at(grid.count - 1), 22.5, 0.01) << "0.45 of the sampling rate";
}

TEST(FrequencyScan, TheStrongestLinesAreDifferentLines) {
  EXPECT_THAT(strongest_lines({1.0, 5.0, 9.0, 8.0, 2.0, 3.0, 3.0, 1.0, 4.0}, 8), testing::ElementsAre(2, 8, 5));
  EXPECT_THAT(strongest_lines({1.0, 5.0, 9.0, 8.0, 2.0, 3.0, 3.0, 1.0, 4.0}, 2), testing::ElementsAre(2, 8));
  EXPECT_THAT(strongest_lines({7.0, 1.0}, 8), testing::ElementsAre(0));
  EXPECT_TRUE(strongest_lines({}, 8).empty());

  const SampleTimes t = {even(0.0, 50.0, 4000)};
  Eigen::VectorXd x = noise(t[0].size(), 8);
  for (std::size_t k = 0; k < t[0].size(); ++k)
    x[static_cast<Eigen::Index>(k)] += 3.0 * std::sin(two_pi * 4.321 * t[0][k]) + 0.5 * std::sin(two_pi * 11.1 * t[0][k]);
  const FrequencyGrid grid = frequency_grid(t, 0.2, 30.0, 1);
  const std::vector<std::size_t> lines = strongest_lines(periodogram(x, t, grid), 8);
  EXPECT_NEAR(grid.at(lines[0]), 4.321, grid.step);
  const bool weaker_too = std::any_of(lines.begin(), lines.end(), [&](std::size_t f) { return std::abs(grid.at(f) - 11.1) < grid.step; });
  EXPECT_TRUE(weaker_too) << "36 times as weak";
}

/// The whole band of a record of an hour and a half at 50 Hz: a sum over all samples at each frequency would be 1.3e11 turns.
TEST(FrequencyScan, OfALongRecordAreScannedOverTheWholeBand) {
  const SampleTimes t = {even(0.0, 50.0, 262144)};
  Eigen::VectorXd x = noise(t[0].size(), 9);
  for (std::size_t k = 0; k < t[0].size(); ++k) x[static_cast<Eigen::Index>(k)] += 0.1 * std::sin(two_pi * 19.0 * t[0][k]);
  const FrequencyGrid grid = frequency_grid(t, 1e-6, 1e3, 3);
  EXPECT_NEAR(grid.at(grid.count), 22.5, 0.01);
  std::vector<double> power(grid.count, 0.0);
  const std::vector<double> line = periodogram(x, t, grid);
  add_over_background(line, power);
  const auto best = static_cast<std::size_t>(std::max_element(power.begin(), power.end()) - power.begin());
  EXPECT_NEAR(grid.at(best), 19.0, grid.step);
  EXPECT_NEAR(line[best], by_definition(x, t, grid.at(best)), 1e-6 * line[best]);
}

TEST(FrequencyScan, ThatTooManyUnevenSamplesForbidAreSaid) {
  std::vector<double> t = {0.0};
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> step(0.01, 0.03);
  for (int k = 0; k < 300000; ++k) t.push_back(t.back() + step(random));
  const FrequencyGrid grid = frequency_grid({t}, 0.2, 12.0, 1);
  EXPECT_LT(grid.at(grid.count), 0.9 * grid.wanted);
  EXPECT_DOUBLE_EQ(grid.wanted, 12.0);
}

}  // namespace
}  // namespace misfit
