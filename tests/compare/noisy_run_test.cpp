#include "misfit/compare/noisy_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "misfit/compare/motion_statistics.h"
#include "tests/model/requests.h"

namespace misfit {
namespace {

using namespace testing_models;

Signals clock(std::size_t samples) {
  Signals s;
  s.name = "flight";
  for (std::size_t i = 0; i < samples; ++i) s.t.push_back(static_cast<double>(i) / 59.94);
  for (const char* name : {"P_y", "P_z"}) s.measured.push_back({name, "px", std::vector<double>(samples, 0.0), 0.0});
  return s;
}

double deviation(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (double v : values) sum += v, squares += v * v;
  const auto n = static_cast<double>(values.size());
  return std::sqrt(squares / n - sum * sum / (n * n));
}

Model gusty(double sigma) {
  Model m = assemble(spherical({effect("gust")}), registry());
  set_parachute_curves(m);
  set(m, "gust_sigma", sigma);
  set(m, "gust_tau", 0.1);
  return m;
}

/// Without a force both runs are the same motion: their difference is the measurement noise.
TEST(NoisyRun, MeasurementsHaveTheWhiteNoiseAndTheResonanceTheyAreGiven) {
  Model still = assemble(spherical(), registry());
  set_parachute_curves(still);
  const Signals like = clock(20000);
  const StochasticModel model{&still, {}, {}, {{0.5, 0.0, 9.0, 0.1}, {0.0, 1.2, 9.0, 0.1}}};
  const auto noisy = noisy_run(model, like, {0.0, 0.2, 0.0, 0.0}, 7);
  const auto quiet = noisy_run({&still, {}, {}, {{}, {}}}, like, {0.0, 0.2, 0.0, 0.0}, 7);
  ASSERT_TRUE(noisy && quiet);
  std::vector<double> white, coloured;
  for (std::size_t i = 0; i < like.samples(); ++i) {
    white.push_back(noisy->measured[0].values[i] - quiet->measured[0].values[i]);
    coloured.push_back(noisy->measured[1].values[i] - quiet->measured[1].values[i]);
  }
  EXPECT_NEAR(deviation(white), 0.5, 0.01);
  EXPECT_NEAR(deviation(coloured), 1.2, 0.1);
  double product = 0.0;
  for (std::size_t i = 0; i + 1 < coloured.size(); ++i) product += coloured[i] * coloured[i + 1];
  const double omega = 2.0 * std::numbers::pi * 9.0, h = 1.0 / 59.94, free = omega * std::sqrt(1.0 - 0.01);
  const double expected = std::exp(-0.1 * omega * h) * (std::cos(free * h) + 0.1 * omega / free * std::sin(free * h));
  EXPECT_NEAR(product / (static_cast<double>(coloured.size()) * 1.2 * 1.2), expected, 0.1);
}

TEST(NoisyRun, WhatIsReadInWholeStepsIsRoundedToTheNearest) {
  Model still = assemble(spherical(), registry());
  set_parachute_curves(still);
  const Signals like = clock(500);
  const std::vector<double> x0{0.0, 0.2, 0.0, 0.0};
  MeasurementNoise in_steps;
  in_steps.step = 0.5, in_steps.level = 0.2;
  const auto exact = noisy_run({&still, {}, {}, {{}, {}}}, like, x0, 7);
  const auto read = noisy_run({&still, {}, {}, {{}, in_steps}}, like, x0, 7);
  ASSERT_TRUE(exact && read);
  EXPECT_EQ(read->measured[0].values, exact->measured[0].values);
  for (std::size_t i = 0; i < like.samples(); ++i) {
    const double value = read->measured[1].values[i];
    ASSERT_NEAR(std::remainder(value - 0.2, 0.5), 0.0, 1e-9);
    ASSERT_LE(std::abs(value - exact->measured[1].values[i]), 0.25);
  }
  EXPECT_GT(deviation(read->measured[1].values), 0.5) << "it moves over several steps";
}

/// Gusts are unit processes times their size: noise added in squares that doubles the process makes up for half the size.
TEST(NoisyRun, NoiseGivenFromOutsideAddsInSquaresToThatOfTheEffect) {
  const Signals like = clock(8000);
  const Model whole = gusty(27.0), half = gusty(13.5);
  const double further = std::sqrt(3.0 * 2.0 / 0.1);
  const std::vector<double> x0{0.0, 0.2, 0.0, 0.0, 0.0, 0.0};
  const auto a = noisy_run({&whole, {}, {1.0, 1.0}, {{}, {}}}, like, x0, 3);
  const auto b = noisy_run({&half, {further, further}, {2.0, 2.0}, {{}, {}}}, like, x0, 3);
  ASSERT_TRUE(a && b);
  EXPECT_GT(deviation(a->measured[1].values), 20.0);
  for (std::size_t i = 0; i < like.samples(); i += 100) EXPECT_NEAR(a->measured[1].values[i], b->measured[1].values[i], 1e-6);
}

TEST(NoisyRun, MissesWhatTheMeasurementMissesAndIsTheSameForTheSameSeed) {
  Signals like = clock(300);
  like.measured[0].values[40] = std::nan("");
  const Model m = gusty(27.0);
  const StochasticModel model{&m, {}, {}, {{0.5}, {0.5}}};
  const std::vector<double> x0{0.0, 0.2, 0.0, 0.0, 0.0, 0.0};
  const auto a = noisy_run(model, like, x0, 1), b = noisy_run(model, like, x0, 1), c = noisy_run(model, like, x0, 2);
  ASSERT_TRUE(a && b && c);
  EXPECT_TRUE(std::isnan(a->measured[0].values[40]));
  EXPECT_EQ(a->measured[1].values, b->measured[1].values);
  EXPECT_NE(a->measured[1].values, c->measured[1].values);
}

}  // namespace
}  // namespace misfit
