#include "misfit/fit/regression/linear_guess.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace misfit {
namespace {

/// tau y' = gain u + rest − y under a held random input.
GuessData first_order(double step, double noise) {
  GuessData data;
  data.drivers.emplace_back();
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  constexpr double tau = 5.0, gain = 2.0, rest = 1.0;
  double y = rest, u = 0.0;
  for (int k = 0; k < 2000; ++k) {
    if (k % 40 == 0) u = normal(random);
    data.t.push_back(step * k);
    data.y.push_back(y + noise * normal(random));
    data.drivers[0].values.push_back(u);
    y += (gain * u + rest - y) * (1.0 - std::exp(-step / tau));
  }
  return data;
}

TEST(LinearGuess, FindsATimeConstant) {
  const LinearGuess guess = guess_linear(first_order(0.5, 0.01));
  EXPECT_EQ(guess.order, 1);
  EXPECT_NEAR(guess.tau, 5.0, 2.0);
  EXPECT_NEAR(guess.gain[0], 2.0, 0.3);
  EXPECT_NEAR(guess.rest, 1.0, 0.2);
}

TEST(LinearGuess, FindsAFreeSwingAboutItsRest) {
  for (const double step : {0.001, 0.05}) {
    GuessData data;
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    for (double t = 0.0; t < 40.0; t += step) {
      data.t.push_back(t);
      data.y.push_back(3.14 + 0.5 * std::exp(-0.05 * t) * std::cos(6.0 * t) + 1e-3 * normal(random));
    }
    const LinearGuess guess = guess_linear(data);
    EXPECT_EQ(guess.order, 2) << guess.why;
    EXPECT_NEAR(std::sqrt(guess.stiffness), 6.0, 0.2);
    EXPECT_NEAR(guess.rest, 3.14, 0.02);
    EXPECT_GT(guess.damping, 0.0);
    EXPECT_LT(guess.damping, 1.0);
  }
}

TEST(LinearGuess, GapsAndMissingValuesDoNotSpoilIt) {
  GuessData data = first_order(0.5, 0.01);
  for (std::size_t k = 300; k < 330; ++k) data.y[k] = std::nan("");
  for (std::size_t k = 1000; k < data.t.size(); ++k) data.t[k] += 500.0;
  const LinearGuess guess = guess_linear(data);
  EXPECT_NEAR(guess.tau, 5.0, 2.0);
}

/// A state that a function advances, measured with noise, under steps of a random input; rate in `velocities` if it has one.
struct World {
  double step = 0.01, noise = 0.0;
  int count = 3000, hold = 60;
  std::vector<double> velocities = {};

  GuessData run(const std::function<double(double, double, double)>& rate, bool second = false) {
    GuessData data;
    data.drivers.emplace_back();
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    double y = 0.0, v = 0.0, u = 0.0;
    for (int k = 0; k < count; ++k) {
      if (k % hold == 0) u = normal(random);
      data.t.push_back(step * k);
      data.y.push_back(y + noise * normal(random));
      data.drivers[0].values.push_back(u);
      velocities.push_back(v + noise * normal(random));
      constexpr int parts = 50;
      for (int i = 0; i < parts; ++i) {
        const double slope = rate(y, v, u) * step / parts;
        v += second ? slope : 0.0;
        y += second ? v * step / parts : slope;
      }
    }
    return data;
  }
};

/// The motor of the first tutorial: dry friction in a lag must not be taken for a swing.
TEST(LinearGuess, DryFrictionDoesNotMakeALagAnOscillator) {
  World world{.step = 0.005, .noise = 0.3, .hold = 120};
  const LinearGuess guess =
      guess_linear(world.run([](double w, double, double u) { return 1000.0 * u - 10.0 * w - 100.0 * std::tanh(w / 0.1); }));
  EXPECT_EQ(guess.order, 1) << guess.why;
  EXPECT_NEAR(guess.tau, 0.1, 0.02);
  EXPECT_NEAR(guess.gain[0], 100.0, 10.0);
  EXPECT_NE(guess.why.find("a second order"), std::string::npos) << guess.why;
}

TEST(LinearGuess, ADrivenSwingIsOfSecondOrderThroughNoise) {
  World world{.step = 0.02, .noise = 0.02, .hold = 30};
  const LinearGuess guess = guess_linear(world.run([](double y, double v, double u) { return u - 9.0 * y - 0.6 * v; }, true));
  ASSERT_EQ(guess.order, 2) << guess.why;
  EXPECT_NEAR(std::sqrt(guess.stiffness), 3.0, 0.1);
  EXPECT_NEAR(guess.damping, 0.6, 0.15);
  EXPECT_NEAR(guess.gain[0], 1.0 / 9.0, 0.01);
}

/// Two time constants: the second is a lag, which discovery names.
TEST(LinearGuess, AnOverdampedAnswerIsOfFirstOrder) {
  World world{.step = 0.02, .noise = 0.002};
  const LinearGuess guess = guess_linear(world.run([](double y, double v, double u) { return 20.0 * (u - y) - 12.0 * v; }, true));
  EXPECT_EQ(guess.order, 1) << guess.why;
}

/// An integral follows the drift as well as the drift itself does.
TEST(LinearGuess, ADriftOfTheRestMakesNoIntegral) {
  World world{.step = 0.2, .noise = 0.01, .hold = 40};
  double t = 0.0;
  constexpr int steps = 50;  // of the integration, per sample
  const LinearGuess guess = guess_linear(world.run([&](double y, double, double u) {
    t += world.step / steps;
    return (2.0 * u + 1.0 + 0.02 * t - y) / 8.0;
  }));
  ASSERT_EQ(guess.order, 1) << guess.why;
  EXPECT_FALSE(guess.integrates);
  EXPECT_NEAR(guess.tau, 8.0, 1.0) << guess.why;
  EXPECT_NEAR(guess.gain[0], 2.0, 0.2);
}

/// The position of a motor, whose rate is not measured.
TEST(LinearGuess, APositionThatADriveIntegratesIsOfSecondOrder) {
  World world{.step = 0.02, .noise = 0.002, .hold = 30};
  GuessData data = world.run([](double, double v, double u) { return 3.0 * u - 1.5 * v; }, true);
  const LinearGuess guess = guess_linear(data);
  ASSERT_EQ(guess.order, 2) << guess.why;
  EXPECT_TRUE(guess.integrates);
  EXPECT_NEAR(guess.damping, 1.5, 0.3);
  EXPECT_GT(guess.undriven, 4.0) << "the voltage is what moves it";
  data.without_inertia = true;  // a temperature that does the same
  EXPECT_EQ(guess_linear(data).order, 1);
}

/// An axis of 0.8 kg on a screw of 8 mm that runs unevenly by 0.3 N, at 12 N/A and 30 N s/m, held to a target by a controller: its current
/// and its position [m].
GuessData axis_on_an_uneven_screw() {
  GuessData data;
  data.drivers.emplace_back();
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> place(-0.12, 0.12), speeds(0.03, 0.15);
  constexpr double step = 0.005;
  double y = 0.0, v = 0.0, target = 0.0, speed = 0.0, followed = 0.0;
  for (int k = 0; k < 3000; ++k) {
    if (k % 250 == 0) {
      target = place(random);
      speed = speeds(random);
    }
    followed += std::clamp(target - followed, -speed * step, speed * step);
    const double current = std::clamp((900.0 * (followed - y) - 10.0 * v) / 12.0 + 0.03 * normal(random), -3.0, 3.0);
    data.t.push_back(step * k);
    data.y.push_back(y + 1e-5 * normal(random));
    data.drivers[0].values.push_back(current);
    constexpr int parts = 50;
    for (int i = 0; i < parts; ++i) {
      v += (12.0 * current - 30.0 * v - 0.3 * std::sin(2.0 * std::numbers::pi * y / 0.008)) / 0.8 * step / parts;
      y += v * step / parts;
    }
  }
  return data;
}

/// A first order follows it with a time constant longer than the record, and would hide both the axis and its screw from the search.
TEST(LinearGuess, AnAxisWhoseScrewRunsUnevenlyIsOfSecondOrder) {
  const LinearGuess guess = guess_linear(axis_on_an_uneven_screw());
  EXPECT_EQ(guess.order, 2) << guess.why;
  EXPECT_TRUE(guess.integrates) << guess.why;
}

/// What the limit takes from a swing is for the search to name; a first order would leave it nothing that swings.
TEST(LinearGuess, ASwingWhoseCommandIsLimitedInItsRateIsOfSecondOrder) {
  World world{.step = 0.05, .noise = 2e-3, .count = 2400, .hold = 90};
  double followed = 0.0;
  const LinearGuess guess = guess_linear(world.run(
      [&](double y, double v, double u) {
        followed += std::clamp(u - followed, -0.0007, 0.0007);  // 0.7 per second, in fiftieths of a step
        return 4.84 * (followed - y) - 3.52 * v;
      },
      true));
  EXPECT_EQ(guess.order, 2) << guess.why;
}

/// Of a stop the linear model knows nothing, so that a second order is hardly better than a first; but it rings.
TEST(LinearGuess, ASwingThatMeetsAStopIsOfSecondOrder) {
  World world{.step = 0.025, .noise = 1.4e-3, .count = 1600, .hold = 50};
  const auto push = [](double y, double v, double u) { return 2.4 * u - 15.0 * y - 1.1 * v - 187.5 * std::max(y - 0.21, 0.0); };
  const LinearGuess guess = guess_linear(world.run(push, true));
  EXPECT_EQ(guess.order, 2) << guess.why;
  EXPECT_FALSE(guess.integrates);
}

TEST(LinearGuess, AMeasuredRateMakesSecondOrderWithoutAPullBackWhereThereIsNone) {
  World world{.step = 0.01, .noise = 0.002};
  GuessData data = world.run([](double, double v, double u) { return 3.0 * u - 1.5 * v + 0.2; }, true);
  data.rate = world.velocities;
  const LinearGuess guess = guess_linear(data);
  ASSERT_EQ(guess.order, 2);
  EXPECT_TRUE(guess.integrates) << guess.why;
  EXPECT_NEAR(guess.damping, 1.5, 0.1);
  EXPECT_NEAR(guess.gain[0], 3.0, 0.1);
  EXPECT_NEAR(guess.rest, 0.2, 0.05);
}

TEST(LinearGuess, AMeasuredRateOfASwingGivesItsPull) {
  World world{.step = 0.01, .noise = 0.002};
  GuessData data = world.run([](double y, double v, double u) { return u - 25.0 * y - 0.5 * v; }, true);
  data.rate = world.velocities;
  const LinearGuess guess = guess_linear(data);
  EXPECT_FALSE(guess.integrates) << guess.why;
  EXPECT_NEAR(std::sqrt(guess.stiffness), 5.0, 0.1);
  EXPECT_NEAR(guess.gain[0], 0.04, 0.004);
}

/// Of two tanks the second is filled by the first, not by the pump; the first by the pump alone.
TEST(LinearGuess, ADriverIsInTheModelOnlyWhereItIsNeeded) {
  World world{.step = 1.0, .noise = 0.01, .hold = 40};
  const GuessData first = world.run([](double y, double, double u) { return (u - y) / 20.0; });
  GuessData second = first;
  double y = 0.0;
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  for (std::size_t k = 0; k < first.t.size(); ++k) {
    second.y[k] = y + 0.01 * normal(random);
    y += (first.y[k] - y) / 30.0;
  }
  second.drivers.push_back({first.y, true, true});
  const LinearGuess filled = guess_linear(second);
  EXPECT_EQ(filled.order, 1) << filled.why;
  EXPECT_EQ(filled.gain[0], 0.0);
  EXPECT_NEAR(filled.gain[1], 1.0, 0.05);
  GuessData pumped = first;
  pumped.drivers.push_back({second.y, true, true});
  const LinearGuess lower = guess_linear(pumped);
  EXPECT_NEAR(lower.gain[0], 1.0, 0.05);
  EXPECT_EQ(lower.gain[1], 0.0);
}

/// y' = 0.55 u_0 − (8.3e-5 + 5.6e-4 u_1) (y − 410): slow, and no linear model fits it well. Over windows of two swings a second order
/// without any input follows it best, by its initial values.
TEST(LinearGuess, AnInputOfASlowMotionThatNoLinearModelFitsIsInTheModel) {
  GuessData data;
  data.drivers.resize(2);
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  double y = 600.0, in = 0.0, open = 0.0;
  for (int k = 0, next_in = 0, next_open = 0; k < 2000; ++k) {
    if (k == next_in) in = 0.3 * static_cast<double>(random() % 3), next_in += 20 + static_cast<int>(random() % 70);
    if (k == next_open) open = std::vector{0.0, 0.0, 0.2, 0.5, 1.0}[random() % 5], next_open += 15 + static_cast<int>(random() % 65);
    data.t.push_back(60.0 * k);
    data.y.push_back(y + 5.0 * normal(random));
    data.drivers[0].values.push_back(in);
    data.drivers[1].values.push_back(open);
    for (int i = 0; i < 60; ++i) y += 0.55 * in - (8.3e-5 + 5.6e-4 * open) * (y - 410.0);
  }
  const LinearGuess guess = guess_linear(data);
  EXPECT_EQ(guess.order, 1) << guess.why;
  EXPECT_FALSE(guess.integrates);
  EXPECT_GT(guess.gain[0], 500.0);
  EXPECT_LT(guess.gain[1], -500.0);
}

/// An input that moves nothing, unless the user says that it acts.
TEST(LinearGuess, AnInputThatTheUserNamesIsInTheModel) {
  GuessData data = first_order(0.5, 0.01);
  data.drivers.emplace_back();
  for (std::size_t k = 0; k < data.t.size(); ++k) data.drivers[1].values.push_back(static_cast<double>(k / 70 % 3));
  EXPECT_EQ(guess_linear(data).gain[1], 0.0);
  data.drivers[1].named = true;
  const LinearGuess guess = guess_linear(data);
  EXPECT_NE(guess.gain[1], 0.0);
  EXPECT_NEAR(guess.gain[0], 2.0, 0.3);
}

TEST(LinearGuess, WhereNothingCanBeFittedNoInputHasTheGainZero) {
  GuessData few;
  few.drivers.emplace_back();
  for (int k = 0; k < 8; ++k) {
    few.t.push_back(k);
    few.y.push_back(k % 3);
    few.drivers[0].values.push_back(k % 2);
  }
  const LinearGuess guess = guess_linear(few);
  EXPECT_GT(std::abs(guess.gain[0]), 0.0);
}

TEST(LinearGuess, SaysWhereThereIsNone) {
  GuessData still;
  for (int k = 0; k < 100; ++k) {
    still.t.push_back(k);
    still.y.push_back(2.0);
  }
  const LinearGuess guess = guess_linear(still);
  EXPECT_EQ(guess.order, 1);
  EXPECT_EQ(guess.rest, 2.0);
  EXPECT_NE(guess.why.find("no linear model"), std::string::npos);
}

/// The mean of many equal values is rounded: they differ from it in the last digit.
TEST(LinearGuess, AConstantDriverHasNoGain) {
  GuessData beside = first_order(0.5, 0.01), alone = beside;
  beside.drivers.push_back({std::vector<double>(beside.t.size(), 0.1), true, false});
  const LinearGuess guess = guess_linear(beside), without = guess_linear(alone);
  ASSERT_EQ(guess.gain.size(), 2U);
  EXPECT_EQ(guess.gain[1], 0.0);
  EXPECT_EQ(guess.gain[0], without.gain[0]);
  EXPECT_EQ(guess.rest, without.rest);
  alone.drivers = {beside.drivers.back()};
  const LinearGuess of_nothing = guess_linear(alone);
  EXPECT_EQ(of_nothing.gain[0], 0.0);
  EXPECT_LT(std::abs(of_nothing.rest), 10.0);
}

}  // namespace
}  // namespace misfit
