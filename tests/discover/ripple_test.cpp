// A force that recurs along the way: a slide whose screw is bent (once per pitch), and a motor that favours some angles (cogging), of
// which only the speed is a state.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "misfit/discover/wave_scan.h"
#include "tests/discover/found.h"
#include "tests/discover/slide.h"

namespace misfit {
namespace {

using namespace testing_models;

constexpr double pitch = 0.02, push = 1.5;  // [m], [m/s^2]

Signals with_a_bent_screw(double size, unsigned seed) {
  return slide({.seed = seed}, [size](double x) { return size * std::cos(2.0 * std::numbers::pi * x / pitch + 0.6); });
}

const std::string motor_text = R"toml(
[states]
w = { unit = "rad/s", scale = 5.0 }
[inputs]
T = { unit = "N m", hold = "zero_order" }
[parameters]
J = { unit = "kg m^2", value = 0.012, free = true }
b = { unit = "N m s", value = 0.01, free = true }
[equations]
w = "(T - b*w)/J"
[outputs]
w = { unit = "rad/s", noise = 0.05 }
)toml";

/// [rad/s^2] Cogging `size` sin(6 angle); 6 pairs of poles; by the midpoint rule in steps of 0.1 ms.
Signals motor(double size, unsigned seed) {
  constexpr double step = 0.01, fine = 1e-4;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "motor";
  s.measured = {{"w", "rad/s", {}, 0.0}};
  s.inputs = {{"T", "N m", {}, 0.0}};
  double angle = 0.0, w = 0.0, torque = 0.0;
  for (int n = 0; n < 2000; ++n) {
    if (n % 50 == 0) torque = 0.1 * normal(random);
    s.t.push_back(step * n);
    s.inputs[0].values.push_back(torque);
    s.measured[0].values.push_back(w + 0.05 * normal(random));
    for (int i = 0; i < 100; ++i) {
      const auto rate = [&](double at, double speed) { return (torque - 0.02 * speed) / 0.01 + size * std::sin(6.0 * at); };
      const double half_w = w + 0.5 * fine * rate(angle, w), half_angle = angle + 0.5 * fine * w;
      angle += fine * half_w;
      w += fine * rate(half_angle, half_w);
    }
  }
  return s;
}

void expect_within(const Estimate& found, double truth, double least_share) {
  EXPECT_NEAR(found.value, truth, 4.0 * found.sigma);
  EXPECT_LT(found.sigma, least_share * std::abs(truth));
}

TEST(AForceThatRecursAlongTheWay, IsFoundWithItsSpacing) {
  const Discovery found = Found(with_a_bent_screw(push, 5), slide_text).discover_missing();
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_EQ(first.effect, "ripple") << found.verdict;
  EXPECT_TRUE(first.accepted) << first.why;
  if (first.effect != "ripple") return;
  expect_within(first.parameters.at("spacing"), pitch, 1e-3);
  expect_within(first.parameters.at("cosine"), push * std::cos(0.6), 0.05);
  expect_within(first.parameters.at("sine"), -push * std::sin(0.6), 0.1);
}

TEST(AForceThatRecursAlongTheWay, IsNotFoundWhereThereIsNone) {
  const Discovery found = Found(with_a_bent_screw(0.0, 6), slide_text).discover_missing();
  EXPECT_EQ(found.outcome, SearchOutcome::none_missing) << found.verdict;
}

/// 0.4 of a spacing is visited: a spring that is not straight.
TEST(AForceThatRecursAlongTheWay, IsOneOfManyCurvesWhereItWasNotSeenToRecur) {
  const Discovery found =
      Found(slide({.seed = 9}, [](double x) { return 2.0 * std::sin(2.0 * std::numbers::pi * x / 0.9); }), slide_text).discover_missing();
  const auto ripple =
      std::find_if(found.candidates.begin(), found.candidates.end(), [](const Candidate& c) { return c.effect == "ripple"; });
  ASSERT_NE(ripple, found.candidates.end());
  ASSERT_TRUE(ripple->actual_drop) << "it is refitted";
  EXPECT_FALSE(ripple->accepted);
  EXPECT_THAT(ripple->why, testing::HasSubstr("along which it does not recur"));
  EXPECT_EQ(found.outcome, SearchOutcome::unknown_form) << found.verdict;
  EXPECT_EQ(found.unexplained_quantity, "x");
}

TEST(AForceThatRecursWithTheAngleTurned, IsFoundWhereOnlyTheSpeedIsAState) {
  const Discovery found = Found(motor(5.0, 7), motor_text).discover_missing();
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_EQ(first.effect, "turning_ripple") << found.verdict;
  EXPECT_TRUE(first.accepted) << first.why;
  if (first.effect != "turning_ripple") return;
  expect_within(first.parameters.at("spacing"), std::numbers::pi / 3.0, 1e-3);
  expect_within(first.parameters.at("sine"), 5.0, 0.1);
}

TEST(AForceThatRecursWithTheAngleTurned, IsNotFoundWhereThereIsNone) {
  const Discovery found = Found(motor(0.0, 8), motor_text).discover_missing();
  EXPECT_EQ(found.outcome, SearchOutcome::none_missing) << found.verdict;
}

TEST(WaveScan, AddsTheMeanOfTheWaveOverEachStep) {
  const Course course{Eigen::Vector3d(0.2, 1.1, -0.7), Eigen::Vector3d(0.4, 0.0, -0.9)};
  const Eigen::VectorXd score = Eigen::Vector3d(1.5, -2.0, 0.8);
  FrequencyGrid grid;
  grid.first = 0.9, grid.step = 0.3, grid.count = 2;
  const std::vector<double> power = wave_power(score, course, grid);
  ASSERT_EQ(power.size(), 2U);
  for (std::size_t f = 0; f < 2; ++f) {
    std::complex<double> sum;
    for (Eigen::Index k = 0; k < 3; ++k) {
      constexpr int parts = 20000;  // the mean over the step, by the midpoint rule
      for (int i = 0; i < parts; ++i) {
        const double at = course.middle[k] + course.moved[k] * ((i + 0.5) / parts - 0.5);
        sum += score[k] / parts * std::polar(1.0, 2.0 * std::numbers::pi * grid.at(f) * at);
      }
    }
    EXPECT_NEAR(power[f], std::norm(sum), 1e-6);
  }
}

TEST(WaveScan, LooksFromTheFewestPeriodsToWhatSlowStepsResolve) {
  Course course{Eigen::VectorXd::LinSpaced(1001, 0.0, 100.0), Eigen::VectorXd::Constant(1001, 0.1)};
  const FrequencyGrid grid = wave_grid(course, 2.0, 1e4, 1);
  EXPECT_DOUBLE_EQ(grid.first, 0.02) << "2 periods over 100";
  EXPECT_DOUBLE_EQ(grid.step, 1.0 / 400.0);
  EXPECT_DOUBLE_EQ(grid.wanted, 4.5) << "0.45 of a wave in a step";
  EXPECT_NEAR(grid.even_length, 100.0, 0.2);
  course.middle.setConstant(3.0);
  EXPECT_EQ(wave_grid(course, 2.0, 1e4, 1).count, 0U) << "nothing moves";
}

}  // namespace
}  // namespace misfit
