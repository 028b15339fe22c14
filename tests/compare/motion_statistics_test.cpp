#include "misfit/compare/motion_statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace misfit {
namespace {

constexpr double step = 0.02;

MotionPath sine(double amplitude, double frequency, std::size_t samples) {
  MotionPath path{"x", "rad", {}};
  for (std::size_t i = 0; i < samples; ++i)
    path.values.push_back(0.3 + amplitude * std::sin(2.0 * std::numbers::pi * frequency * step * static_cast<double>(i)));
  return path;
}

/// A damped resonance driven by noise, with a level.
MotionPath random_motion(unsigned seed, double size, std::size_t samples = 1500) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  MotionPath path{"x", "rad", {}};
  double x = 0.0, v = 0.0;
  constexpr double omega = 6.0, damping = 0.2;
  for (std::size_t i = 0; i < samples + 200; ++i) {
    v += step * (-omega * omega * x - 2.0 * damping * omega * v) + size * std::sqrt(step) * normal(random);
    x += step * v;
    if (i >= 200) path.values.push_back(x);
  }
  return path;
}

const MotionGroup& group(const MotionSeries& series, const std::string& name) {
  for (const auto& g : series.groups) {
    if (g.name == name) return g;
  }
  throw std::runtime_error("no group " + name);
}

MotionSeries compared(const MotionPath& measured, unsigned first_seed, std::size_t runs, double* overall = nullptr) {
  const MotionScales scales = scales_of(measured, step);
  std::vector<MotionNumbers> simulated;
  for (std::size_t k = 0; k < runs; ++k)
    simulated.push_back(motion_numbers(random_motion(first_seed + static_cast<unsigned>(k), 1.0, measured.values.size()), scales));
  MotionDistances distances;
  MotionSeries out = compare_motion(measured, scales, simulated, distances);
  out.experiment = "flight";
  if (overall != nullptr) *overall = overall_p_value(distances);
  return out;
}

TEST(MotionScales, ThePeriodIsThatOfTheMotion) {
  const MotionScales scales = scales_of(sine(0.1, 1.25, 2000), step);
  EXPECT_NEAR(static_cast<double>(scales.period) * step, 0.8, 0.1);
  EXPECT_NEAR(static_cast<double>(scales.lags.back()) * step, 2.4, 0.3);
  EXPECT_NEAR(scales.frequencies.back(), 12.5, 1.5);
}

TEST(MotionNumbers, OfASineAreThoseOfASine) {
  const MotionPath path = sine(0.1, 1.25, 4000);
  const MotionScales scales = scales_of(path, step);
  const MotionNumbers numbers = motion_numbers(path, scales);
  EXPECT_NEAR(numbers[0][0], 0.3, 1e-3);
  EXPECT_NEAR(numbers[0][1], 0.1 / std::numbers::sqrt2, 1e-3);
  EXPECT_NEAR(numbers[0][8], 0.3, 1e-3) << "median";
  EXPECT_NEAR(numbers[1][0], 0.1, 3e-3) << "amplitude";
  for (std::size_t k = 0; k < scales.lags.size(); ++k)
    EXPECT_NEAR(numbers[2][k], std::cos(2.0 * std::numbers::pi * 1.25 * step * static_cast<double>(scales.lags[k])), 0.02);
  const auto highest = std::max_element(numbers[3].begin(), numbers[3].end()) - numbers[3].begin();
  EXPECT_NEAR(scales.frequencies[static_cast<std::size_t>(highest)], 1.25, scales.frequencies[0]);
}

TEST(MotionNumbers, GapsMoveThemLittle) {
  const MotionPath whole = random_motion(1, 1.0, 6000);
  MotionPath gappy = whole;
  for (std::size_t i = 0; i < gappy.values.size(); i += 7) gappy.values[i] = std::nan("");
  const MotionScales scales = scales_of(whole, step);
  const MotionNumbers a = motion_numbers(whole, scales), b = motion_numbers(gappy, scales);
  for (std::size_t g = 0; g < 3; ++g) {
    for (std::size_t k = 0; k < a[g].size(); ++k) EXPECT_NEAR(b[g][k], a[g][k], 0.03 * std::abs(a[0][1]) + (g == 2 ? 0.02 : 0.0));
  }
}

TEST(MotionNumbers, OfNothingAreNotNumbers) {
  const MotionPath path{"x", "rad", std::vector<double>(50, std::nan(""))};
  const MotionNumbers numbers = motion_numbers(path, scales_of(path, step));
  for (const auto& list : numbers) {
    for (double v : list) EXPECT_FALSE(std::isfinite(v));
  }
}

TEST(CompareMotion, MotionOfTheSameKindStaysInTheBand) {
  const MotionSeries series = compared(random_motion(1, 1.0), 100, 99);
  for (const auto& g : series.groups) EXPECT_GT(g.p_value, 0.01) << g.name;
}

TEST(CompareMotion, StatisticsThatTheMeasuredMotionDoesNotGiveAreNotCounted) {
  const MotionPath measured = random_motion(1, 1.0);
  const MotionScales scales = scales_of(measured, step);
  MotionPath sparse = measured;  // single samples, 40 apart: no window is half full
  for (std::size_t i = 0; i < sparse.values.size(); ++i) {
    if (i % 40 != 0) sparse.values[i] = std::nan("");
  }
  std::vector<MotionNumbers> simulated;
  for (unsigned k = 0; k < 19; ++k) simulated.push_back(motion_numbers(random_motion(100 + k, 1.0), scales));
  MotionDistances distances;
  SimulatedMotion motion;
  motion.series = {compare_motion(sparse, scales, simulated, distances)};
  EXPECT_EQ(distances.size(), motion.series[0].groups.size());
  std::size_t known = 0;
  for (const MotionGroup& g : motion.series[0].groups) {
    EXPECT_NE(g.name, "amplitude");
    for (const MotionNumber& n : g.numbers) known += std::isfinite(n.measured) ? 1 : 0;
  }
  EXPECT_LT(known, 60U) << "of lags only those of 40 samples exist";
  motion.p_value = 1.0;
  conclude_motion(motion);
  EXPECT_THAT(motion.sentences.front(), testing::HasSubstr("over " + std::to_string(distances.size()) + " groups"));
  EXPECT_THAT(motion.sentences.back(), testing::HasSubstr(" of " + std::to_string(known) + " statistics"));
}

TEST(CompareMotion, LargerMotionIsNamed) {
  SimulatedMotion motion;
  motion.runs = 99;
  motion.series = {compared(random_motion(1, 1.6), 100, 99, &motion.p_value)};
  const MotionGroup& distribution = group(motion.series[0], "distribution");
  EXPECT_DOUBLE_EQ(distribution.p_value, 0.01);
  EXPECT_TRUE(distribution.numbers[1].outside);
  EXPECT_GT(group(motion.series[0], "autocorrelation").p_value, 0.01) << "of the same shape";
  conclude_motion(motion);
  EXPECT_DOUBLE_EQ(motion.p_value, 0.01);
  EXPECT_THAT(motion.sentences.front(),
              testing::StartsWith("the fitted model does not reproduce the statistics of the measured motion: p ≤ 0.01"));
  EXPECT_THAT(motion.sentences, testing::Contains(testing::StartsWith("the distribution of x (flight): p = 0.01")));
}

/// By exchange of the measured motion with any simulated one, P(p ≤ 0.1) is at most 0.1: of 150 trials 15 are expected, 27 is three sigma.
TEST(CompareMotion, PValuesOfTheSameKindAreSpreadEvenly) {
  int small = 0, small_overall = 0;
  for (unsigned trial = 0; trial < 150; ++trial) {
    double overall = 1.0;
    const MotionSeries series = compared(random_motion(10000 + trial, 1.0, 400), 20000 + 100 * trial, 19, &overall);
    small += group(series, "distribution").p_value <= 0.1 ? 1 : 0;
    small_overall += overall <= 0.1 ? 1 : 0;
  }
  for (int count : {small, small_overall}) {
    EXPECT_LE(count, 27);
    EXPECT_GE(count, 4);
  }
}

/// Two experiments, each run simulating both: one p-value over all groups of both. `departs`: how much larger the second one's motion is.
SimulatedMotion two_experiments(unsigned seed, double departs, std::size_t runs, std::size_t samples) {
  SimulatedMotion out;
  out.runs = runs;
  MotionDistances distances;
  for (const unsigned experiment : {0U, 1U}) {
    const MotionPath measured = random_motion(seed + experiment, experiment == 0 ? 1.0 : departs, samples);
    const MotionScales scales = scales_of(measured, step);
    std::vector<MotionNumbers> simulated;
    for (unsigned run = 0; run < runs; ++run)
      simulated.push_back(motion_numbers(random_motion(seed + 10 + 2 * run + experiment, 1.0, samples), scales));
    out.series.push_back(compare_motion(measured, scales, simulated, distances));
    out.series.back().experiment = experiment == 0 ? "calm" : "wild";
  }
  EXPECT_EQ(distances.size(), 8U) << "four groups of each experiment";
  out.p_value = overall_p_value(distances);
  conclude_motion(out);
  return out;
}

TEST(CompareMotion, OneOfTwoExperimentsThatDepartsIsNamed) {
  const SimulatedMotion motion = two_experiments(500, 1.6, 99, 1500);
  EXPECT_DOUBLE_EQ(motion.p_value, 0.01) << "the calm one does not dilute it";
  EXPECT_THAT(motion.sentences, testing::Contains(testing::StartsWith("the distribution of x (wild): p = 0.01")));
  EXPECT_THAT(motion.sentences, testing::Not(testing::Contains(testing::HasSubstr("(calm)"))));
}

TEST(CompareMotion, TwoExperimentsOfTheSameKindHaveOneVerdict) {
  const SimulatedMotion motion = two_experiments(900, 1.0, 99, 1500);
  EXPECT_GT(motion.p_value, 0.01);
  EXPECT_THAT(motion.sentences.front(),
              testing::StartsWith("no difference between the statistics of the measured and the simulated motion is significant at 1 %"));
}

/// As for one experiment: of 150 trials 15 are expected at or below 0.1; the smaller of two p-values by themselves would give some 28.
TEST(CompareMotion, TheJointRankOfTwoExperimentsIsSpreadEvenly) {
  int small = 0;
  for (unsigned trial = 0; trial < 150; ++trial) small += two_experiments(100000 + 100 * trial, 1.0, 19, 400).p_value <= 0.1 ? 1 : 0;
  EXPECT_LE(small, 27);
  EXPECT_GE(small, 4);
}

}  // namespace
}  // namespace misfit
