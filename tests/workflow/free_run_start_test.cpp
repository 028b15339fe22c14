// Starts that the regression cannot give. A heated block whose sensor is late: a random force with a long memory explains all that the
// model does not explain yet. A cylinder whose pressure is measured late: the regression ends at values from which the model cannot be run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "tests/workflow/text_study.h"

namespace {

using namespace misfit;

constexpr double time_constant = 60.0, gain = 90.0, delay = 7.3, ambient = 295.15;

/// By Euler steps of a twentieth of a sample.
std::string recording() {
  std::string text = "t[s],u[-],T[K]\n";
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0.0, 0.05);
  constexpr std::array heating = {0.0, 0.4, 0.2, 0.6, 0.1};
  constexpr int samples = 900, steps = 20, hold = 45;
  const auto input = [&](double t) { return t < 0.0 ? 0.0 : heating[static_cast<std::size_t>(t / hold) * 7919 % heating.size()]; };
  double T = ambient;
  for (int i = 0; i < samples; ++i) {
    char row[60];
    std::snprintf(row, sizeof row, "%d,%g,%.3f\n", i, input(i), T + noise(random));
    text += row;
    for (int k = 0; k < steps; ++k) {
      const double t = i + static_cast<double>(k) / steps;
      T += (gain * input(t - delay) - (T - ambient)) / time_constant / steps;
    }
  }
  return text;
}

constexpr const char* heated_block = R"toml([system]
doc = "a heated block"
[states]
T = { unit = "K", initial = "free" }
[inputs]
u = { unit = "-", hold = "zero_order" }
[parameters]
tau = { unit = "s", value = 30.0, bounds = [1.0, 1000.0], free = true }
gain = { unit = "K", value = 100.0, free = true }
ambient = { unit = "K", value = 293.0, free = true }
[equations]
T = "(gain*u - (T - ambient))/tau"
[outputs]
T = { unit = "K", noise = 0.05 }
)toml";

TEST(AHeatedBlockWithALateSensor, IsFittedByTheFilterNotWorseThanByOutputError) {
  testing_text_study::TextStudy study(heated_block, recording());
  const std::string late = "sensor_delay = {}";
  const Fit freely = study.fit("output_error", late), filtered = study.fit("filter_error", late);
  ASSERT_TRUE(freely.loglik && filtered.loglik) << freely.message << filtered.message;
  EXPECT_GT(*filtered.loglik, *freely.loglik - 0.5) << "its model contains that of output error: a random force of 0";
  constexpr double of_the_approximation = 0.3;  // [s] a rational one, seen by a step of the input
  EXPECT_NEAR(filtered.parameters.at("sensor_delay").value, delay, of_the_approximation);
  EXPECT_NEAR(filtered.parameters.at("tau").value, time_constant, 0.6);
  EXPECT_NEAR(filtered.parameters.at("gain").value, gain, 0.6);
}

TEST(AHeatedBlockWhoseHeaterActsLate, HasItsDelayWithinItsIntervalThoughTheHeaterJumps) {
  testing_text_study::TextStudy study(heated_block, recording());
  for (const char* method : {"output_error", "filter_error"}) {
    const Fit fit = study.fit(method, "delay = { input = \"u\" }");
    ASSERT_TRUE(fit.loglik) << fit.message;
    for (const auto& [name, value] : std::map<std::string, double>{{"delay", delay}, {"tau", time_constant}, {"gain", gain}}) {
      const Estimate& estimate = fit.parameters.at(name);
      EXPECT_NEAR(estimate.value, value, 3.5 * estimate.sigma) << method << ", " << name << " ± " << estimate.sigma;
      EXPECT_LT(estimate.sigma, 0.01 * value) << method << ", " << name;
    }
  }
}

/// A valve-controlled cylinder against a spring, its pressure measured 65 ms late; by Euler steps of half a millisecond.
std::string recording_of_cylinder() {
  constexpr double m = 58.2190084, A = 0.00135643632, k = 11500.0, b = 690.0, C = 6.4e10, Kq = 0.00028, Kc = 1.1e-10;
  constexpr double dt = 0.013;
  constexpr int samples = 900, steps = 26;
  constexpr double h = dt / steps;
  constexpr std::size_t steps_late = 130;  // 0.065 s
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> opening(-1.0, 1.0);
  std::uniform_int_distribution<int> hold(10, 45);
  std::vector<double> pressures;
  std::string text = "t[s],u[-],x[m],p[Pa]\n";
  double x = 0.0, v = 0.0, p = 0.0, u = 0.5;
  for (int i = 0, next = 0; i < samples; ++i) {
    if (i >= next) {
      u = opening(random);
      next = i + hold(random);
    }
    const double shown = pressures.size() > steps_late ? pressures[pressures.size() - 1 - steps_late] : 0.0;
    char row[80];
    std::snprintf(row, sizeof row, "%.3f,%.5f,%.6f,%.1f\n", i * dt, u, x + 0.0004 * normal(random), shown + 4000.0 * normal(random));
    text += row;
    for (int step = 0; step < steps; ++step) {
      pressures.push_back(p);
      const double acceleration = (A * p - k * x - b * v) / m, pressure_rate = C * (Kq * u - A * v - Kc * p);
      v += h * acceleration;
      x += h * v;
      p += h * pressure_rate;
    }
  }
  return text;
}

TEST(ACylinderWithALatePressure, IsFittedFromTheStudysOwnValuesWhereTheRegressionsCannotBeRun) {
  testing_text_study::TextStudy study(R"toml([system]
doc = "a valve-controlled cylinder"
[states]
x = { unit = "m", scale = 0.1 }
v = { unit = "m/s", rate_of = "x", scale = 0.2 }
p = { unit = "Pa", scale = 1e6 }
[inputs]
u = { unit = "-", hold = "zero_order" }
[parameters]
m = { unit = "kg", value = 58.2190084 }
A = { unit = "m^2", value = 0.00135643632 }
k = { unit = "N/m", value = 10234.1, free = true }
b = { unit = "N s/m", value = 678.0, free = true }
C = { unit = "Pa/m^3", value = 6.36e10, free = true }
Kq = { unit = "m^3/s", value = 0.000223, free = true }
Kc = { unit = "m^3/s/Pa", value = 1.06e-10, free = true }
[equations]
v = "(A*p - k*x - b*v)/m"
p = "C*(Kq*u - A*v - Kc*p)"
[outputs]
x = { unit = "m", noise = 0.001 }
p = { unit = "Pa", noise = 1e4 }
)toml",
                                      recording_of_cylinder());
  for (const char* method : {"output_error", "filter_error"}) {
    const Fit fit = study.fit(method, "");
    EXPECT_TRUE(fit.usable()) << method << ": " << fit.message;
    EXPECT_THAT(fit.warnings, testing::Contains(testing::HasSubstr("began at the study's own"))) << method;
  }
}

}  // namespace
