// How well the motion is integrated in a fit: what its error does to the estimates, without a key.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/regression/equation_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "tests/model/declared_texts.h"
#include "tests/sim/reference_integrator.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::HasSubstr;

constexpr double stiffness = 1.8e5, damping = 20.0, gain = 1e5, cubic = 7e5;

const std::string oscillator = R"toml(
[states]
y = { unit = "V", scale = 0.1 }
v = { unit = "V/s", scale = 40.0 }
[inputs]
u = { unit = "V", hold = "first_order" }
[parameters]
stiffness = { unit = "1/s^2", value = 1.5e5, bounds = [0.0, 1e9], free = true }
damping = { unit = "1/s", value = 10.0, bounds = [0.0, 1e5], free = true }
gain = { unit = "1/s^2", value = 1.2e5, bounds = [-1e9, 1e9], free = true }
cubic = { unit = "1/V^2/s^2", value = 1e5, bounds = [-1e9, 1e9], free = true }
[equations]
y = "v"
v = "gain*u - damping*v - stiffness*y - cubic*y^3"
[outputs]
y = { unit = "V", noise = 1e-3 }
)toml";

/// A driven Duffing oscillator: a period has nine samples, at the largest swing seven.
Signals driven_duffing(double noise) {
  constexpr double rate = 610.0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> phase(0.0, 6.28318530718);
  std::normal_distribution<double> normal;
  std::vector<double> phases;
  for (int k = 0; k < 40; ++k) phases.push_back(phase(random));
  Signals s;
  s.name = "multisine";
  s.measured = {{"y", "V", {}, 0.0}};
  s.inputs = {{"u", "V", {}, 0.0}};
  for (int i = 0; i < 2000; ++i) {
    s.t.push_back(i / rate);
    double u = 0.0;
    for (int k = 0; k < 40; ++k) u += 0.02 * std::cos(6.28318530718 * (5.0 + 3.1 * k) * s.t.back() + phases[k]);
    s.inputs[0].values.push_back(u);
  }
  std::size_t at = 0;
  const auto rates = [&](const std::vector<double>& x, std::vector<double>& dx, double t) {
    const std::vector<double>& u = s.inputs[0].values;
    const double now = u[at] + (t - s.t[at]) * rate * (u[at + 1] - u[at]);
    dx = {x[1], gain * now - damping * x[1] - stiffness * x[0] - cubic * x[0] * x[0] * x[0]};
  };
  ReferenceIntegrator integrator(rates, {0.0, 0.0}, 0.0, false);
  for (; at < s.samples(); ++at) {
    s.measured[0].values.push_back(integrator.x()[0] + noise * normal(random));
    if (at + 1 < s.samples()) integrator.advance(s.t[at], s.t[at + 1], true);
  }
  return s;
}

FittedModel fitted(const std::string& text, const std::vector<Signals>& experiments) {
  const auto known = registry_with(text);
  FittedModel out = output_error(equation_error(assemble(request_of("text"), *known), experiments), experiments);
  EXPECT_EQ(out.fit.status, FitStatus::converged) << out.fit.message;
  return out;
}

TEST(Integration, OfADuffingOscillatorWithoutNoiseLeavesItsParametersExact) {
  const Fit fit = fitted(oscillator, {driven_duffing(0.0)}).fit;
  EXPECT_NEAR(fit.parameters.at("stiffness").value, stiffness, 1e-7 * stiffness);
  EXPECT_NEAR(fit.parameters.at("damping").value, damping, 1e-6 * damping);
  EXPECT_NEAR(fit.parameters.at("gain").value, gain, 1e-6 * gain);
  EXPECT_NEAR(fit.parameters.at("cubic").value, cubic, 1e-6 * cubic);
  EXPECT_THAT(fit.facts.at("integration"), HasSubstr("planned anew at the estimate"));
}

TEST(Integration, OfADuffingOscillatorWithLittleNoiseLeavesItsParametersWithinTheirSigmas) {
  const Fit fit = fitted(oscillator, {driven_duffing(1e-5)}).fit;
  const auto expect = [&](const std::string& name, double truth) {
    const Estimate& found = fit.parameters.at(name);
    EXPECT_NEAR(found.value, truth, 3.0 * found.sigma) << name;
    EXPECT_LT(found.sigma, 1e-3 * truth) << name;
  };
  expect("stiffness", stiffness);
  expect("damping", damping);
  expect("gain", gain);
  expect("cubic", cubic);
}

/// A slow tank behind a valve that follows its command within 10 microseconds, read ten times a second.
const std::string stiff_tank = R"toml(
[states]
y = { unit = "m", scale = 1.0 }
z = { unit = "m/s", scale = 0.1 }
[inputs]
u = { unit = "m/s", hold = "zero_order" }
[parameters]
valve = { unit = "s", value = 1e-5 }
drain = { unit = "1/s", value = 0.3, bounds = [0.0, 10.0], free = true }
inflow = { unit = "-", value = 0.7, bounds = [0.0, 10.0], free = true }
[equations]
y = "inflow*z - drain*y"
z = "(u - z)/valve"
[outputs]
y = { unit = "m", noise = 1e-2 }
)toml";

Signals tank_record() {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "tank";
  s.measured = {{"y", "m", {}, 0.0}};
  s.inputs = {{"u", "m/s", {}, 0.0}};
  double y = 0.4;
  for (int i = 0; i < 400; ++i) {
    const double u = i % 50 < 25 ? 0.6 : 0.1;
    s.t.push_back(0.1 * i);
    s.inputs[0].values.push_back(u);
    s.measured[0].values.push_back(y + 5e-3 * normal(random));
    const double decay =
        std::exp(-0.5 * 0.1);  // drain 0.5, inflow 1: the valve's lag of 10 microseconds is nothing beside a sampling interval
    y = y * decay + u / 0.5 * (1.0 - decay);
  }
  return s;
}

TEST(Integration, OfAStiffSystemIsImplicitAndItsParametersAreFound) {
  const Fit fit = fitted(stiff_tank, {tank_record()}).fit;
  EXPECT_THAT(fit.facts.at("integration"), HasSubstr("Radau IIA"));
  EXPECT_NEAR(fit.parameters.at("drain").value, 0.5, 3.0 * fit.parameters.at("drain").sigma);
  EXPECT_NEAR(fit.parameters.at("inflow").value, 1.0, 3.0 * fit.parameters.at("inflow").sigma);
  EXPECT_LT(fit.parameters.at("drain").sigma, 0.02);
}

TEST(Integration, OfAStiffSystemGivesTheFilterTheSameBitsForAnyNumberOfThreads) {
  const std::vector<Signals> experiments = {tank_record()};
  const auto known = registry_with(stiff_tank);
  const FittedModel start = equation_error(assemble(request_of("text"), *known), experiments);
  std::vector<Fit> fits;
  for (const int threads : {1, 3}) {
    FilterOptions options;
    options.threads = threads;
    fits.push_back(filter_error(start, experiments, options).fit);
  }
  ASSERT_EQ(fits[0].status, FitStatus::converged) << fits[0].message;
  EXPECT_THAT(fits[0].facts.at("integration"), HasSubstr("Radau IIA"));
  EXPECT_EQ(fits[0].loglik, fits[1].loglik);
  for (const auto& [name, estimate] : fits[0].parameters) {
    EXPECT_EQ(estimate.value, fits[1].parameters.at(name).value) << name;
    EXPECT_EQ(estimate.sigma, fits[1].parameters.at(name).sigma) << name;
  }
  EXPECT_NEAR(fits[0].parameters.at("drain").value, 0.5, 4.0 * fits[0].parameters.at("drain").sigma);
}

}  // namespace
}  // namespace misfit
