// Systems given as text, fitted to motion that plain loops integrated.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "misfit/fit/methods.h"
#include "misfit/fit/regression/equation_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::HasSubstr;

const std::string tanks_text = R"toml(
[states]
x1 = { unit = "V", min = 0.0, scale = 5.0, initial = "shared" }
x2 = { unit = "V", min = 0.0, scale = 5.0, initial = "shared" }
[inputs]
u = { unit = "V", hold = "zero_order" }
[parameters]
k1 = { unit = "V^0.5/s", value = 0.04, bounds = [0.0, 1.0], free = true }
k2 = { unit = "V^0.5/s", value = 0.04, bounds = [0.0, 1.0], free = true }
k3 = { unit = "V^0.5/s", value = 0.04, bounds = [0.0, 1.0], free = true }
k4 = { unit = "1/s", value = 0.03, bounds = [0.0, 1.0], free = true }
[equations]
x1 = "-k1*sqrt(x1) + k4*u"
x2 = "k2*sqrt(x1) - k3*sqrt(x2)"
[outputs]
y = { unit = "V", formula = "x2", noise = 0.01 }
)toml";

struct TankTruth {
  double k1 = 0.055, k2 = 0.05, k3 = 0.06, k4 = 0.045, spill = 0.0, level = 1e9, x1 = 4.0, x2 = 5.2;
};

/// Small Euler steps: another way than the program's.
Signals tanks(const TankTruth& truth, unsigned seed, std::size_t samples = 500, double noise = 0.01) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.5, 6.0);
  Signals s;
  s.name = "record " + std::to_string(seed);
  s.measured = {{"y", "V", {}, 0.0}};
  s.inputs = {{"u", "V", {}, 0.0}};
  double x1 = truth.x1, x2 = truth.x2, u = 3.0;
  for (std::size_t i = 0; i < samples; ++i) {
    if (i % 25 == 0) u = uniform(random);
    s.t.push_back(4.0 * static_cast<double>(i));
    s.inputs[0].values.push_back(u);
    s.measured[0].values.push_back(x2 + noise * normal(random));
    constexpr int parts = 4000;
    for (int k = 0; k < parts; ++k) {
      const double h = 4.0 / parts, over = std::max(x1 - truth.level, 0.0) * truth.spill;
      const double d1 = -truth.k1 * std::sqrt(x1) + truth.k4 * u, d2 = truth.k2 * std::sqrt(x1) - truth.k3 * std::sqrt(x2) + over;
      x1 = std::max(x1 + h * d1, 0.0);
      x2 = std::max(x2 + h * d2, 0.0);
    }
  }
  return s;
}

FittedModel fit(const Model& model, const std::vector<Signals>& experiments) {
  OutputErrorStart options;
  options.from_regression = false;
  return output_error(equation_error(model, experiments), experiments, options);
}

void expect_recovered(const Fit& result, const std::string& name, double truth) {
  const Estimate& e = result.parameters.at(name);
  EXPECT_GT(e.sigma, 0.0) << name;
  EXPECT_NEAR(e.value, truth, 4.0 * e.sigma + 1e-4 * std::abs(truth)) << name;
}

TEST(DeclaredTanks, OneRecordLeavesTheScaleOfTheHiddenLevelOpen) {
  // x1 may be scaled by s if k1 and k2 are scaled by sqrt(s), 1/sqrt(s) and k4 by s: one direction of four parameters and x1(0).
  const auto known = registry_with(tanks_text);
  const FittedModel fitted = fit(assemble(request_of("text"), *known), {tanks({}, 1)});
  EXPECT_EQ(fitted.fit.status, FitStatus::failed);
  EXPECT_THAT(fitted.fit.message, HasSubstr("k1, k2 and k4"));
}

TEST(DeclaredTanks, AreRecoveredFromTwoRecordsThatBeginAlike) {
  const auto known = registry_with(tanks_text);
  ModelRequest request = request_of("text");
  request.parameters["k2"].free = false;
  request.parameters["k2"].value = 0.05;
  const FittedModel fitted = fit(assemble(request, *known), {tanks({}, 1), tanks({}, 2, 300)});
  ASSERT_EQ(fitted.fit.status, FitStatus::converged) << fitted.fit.message;
  const TankTruth truth;
  expect_recovered(fitted.fit, "k1", truth.k1);
  expect_recovered(fitted.fit, "k3", truth.k3);
  expect_recovered(fitted.fit, "k4", truth.k4);
  EXPECT_NEAR((fitted.initial_states[0] - fitted.initial_states[1]).norm(), 0.0, 1e-6) << "shared";
  EXPECT_NEAR(fitted.initial_states[0][1], truth.x2, 0.02);
  EXPECT_NEAR(fitted.fit.rms.at("y").value, 0.01, 0.001);
}

TEST(DeclaredTanks, FixedInitialStatesStayWhereTheyAre) {
  const auto known = registry_with(tanks_text);
  ModelRequest request = request_of("text");
  request.parameters["k2"].free = false;
  request.parameters["k2"].value = 0.05;
  request.initial["x1"] = {Initial::fixed, 4.0, {}};
  request.initial["x2"] = {Initial::free, std::nullopt, {}};
  const FittedModel fitted = fit(assemble(request, *known), {tanks({}, 3)});
  ASSERT_EQ(fitted.fit.status, FitStatus::converged) << fitted.fit.message;
  EXPECT_NEAR(fitted.initial_states[0][0], 4.0, 1e-6);
  expect_recovered(fitted.fit, "k1", TankTruth{}.k1);
}

TEST(DeclaredEffect, WithAKinkAtAFreeLevelConverges) {
  TankTruth truth;
  truth.spill = 0.02;
  truth.level = 12.0;
  const auto known = registry_with(tanks_text);
  auto with = std::make_shared<Registry>(Registry::over(*known));
  with->add(declared_effect(
      effect_in_one_line(
          "spill",
          R"toml({ port = "dx2/dt", formula = "c*max(x1 - level, 0)", parameters = { c = { unit = "1/s", value = 0.005, bounds = [0, 1] }, level = { unit = "V", value = 9.0, bounds = [0, 30] } } })toml"),
      known->system("text").make({})->spec()));
  ModelRequest request = request_of("text", {effect("spill")});
  request.parameters["k2"].free = false;
  request.parameters["k2"].value = 0.05;
  const FittedModel fitted = fit(assemble(request, *with), {tanks(truth, 4, 800)});
  ASSERT_EQ(fitted.fit.status, FitStatus::converged) << fitted.fit.message;
  expect_recovered(fitted.fit, "c", truth.spill);
  expect_recovered(fitted.fit, "level", truth.level);
  EXPECT_NEAR(fitted.fit.rms.at("y").value, 0.01, 0.001);
}

/// A damped oscillation, y'' = −30 y − 0.4 y' + 10 u, in small steps.
Signals oscillation(bool driven) {
  Signals s;
  s.name = "oscillation";
  s.measured = {{"y", "V", {}, 0.0}};
  s.inputs = {{"u", "V", {}, 0.0}};
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  double y = 1.0, v = 0.0;
  for (int i = 0; i < 600; ++i) {
    const double t = 0.02 * i, next = 0.02 * (i + 1);
    const auto u = [&](double at) { return driven ? std::sin(3.0 * at) + std::sin(7.3 * at) : 0.0; };
    s.t.push_back(t);
    s.inputs[0].values.push_back(u(t));
    s.measured[0].values.push_back(y + 0.002 * normal(random));
    constexpr int parts = 200;
    for (int k = 0; k < parts; ++k) {  // leapfrog, the input straight between samples
      const double h = 0.02 / parts, share = (k + 0.5) / parts, input = u(t) + share * (u(next) - u(t));
      y += 0.5 * h * v;
      v = (v * (1.0 - 0.2 * h) + h * (10.0 * input - 30.0 * y)) / (1.0 + 0.2 * h);
      y += 0.5 * h * v;
    }
  }
  return s;
}

TEST(DeclaredDuffing, IsRecoveredFromAnIndependentIntegration) {
  const auto known = registry_with(duffing_text);
  ModelRequest request = request_of("text");
  request.parameters["gain"].free = true;
  request.parameters["stiffness"].value = 20.0;
  const FittedModel start = equation_error(assemble(request, *known), {oscillation(true)});
  EXPECT_EQ(start.fit.status, FitStatus::converged) << start.fit.message;
  const std::vector<Signals> experiments{oscillation(true)};
  const FittedModel fitted = output_error(start, experiments);
  ASSERT_EQ(fitted.fit.status, FitStatus::converged) << fitted.fit.message;
  expect_recovered(fitted.fit, "stiffness", 30.0);
  expect_recovered(fitted.fit, "damping", 0.4);
  expect_recovered(fitted.fit, "gain", 10.0);
  expect_recovered(fitted.fit, "cubic", 0.0);
}

TEST(DeclaredModels, TwoParametersThatOccurOnlyAsAProductAreNamed) {
  std::string text = duffing_text;
  text.replace(text.find("gain*u"), 6, "gain*lever*u");
  text.replace(text.find("gain = {"), 0, "lever = { unit = \"-\", value = 2.0, free = true }\n");
  const auto known = registry_with(text);
  ModelRequest request = request_of("text");
  request.parameters["gain"].free = true;
  const FittedModel fitted = fit(assemble(request, *known), {oscillation(true)});
  EXPECT_EQ(fitted.fit.status, FitStatus::failed);
  EXPECT_THAT(fitted.fit.message, HasSubstr("lever and gain separately: only their product acts"));
}

TEST(DeclaredModels, AParameterThatTheDataDoNotTouchIsNamed) {
  const auto known = registry_with(duffing_text);
  ModelRequest request = request_of("text");
  request.parameters["gain"].free = true;
  const FittedModel fitted = fit(assemble(request, *known), {oscillation(false)});
  EXPECT_EQ(fitted.fit.status, FitStatus::failed);
  EXPECT_THAT(fitted.fit.message, HasSubstr("nothing in these data depends on gain"));
}

const std::string cylinder_text = R"toml(
[states]
x = { unit = "m", scale = 0.1 }
v = { unit = "m/s", rate_of = "x", scale = 0.2 }
p = { unit = "Pa", scale = 1e6 }
[inputs]
u = { unit = "-", hold = "first_order" }
[parameters]
m = { unit = "kg", value = 44.0 }
A = { unit = "m^2", value = 1.13e-3 }
k = { unit = "N/m", value = 16000, free = true }
b = { unit = "N s/m", value = 640, free = true }
C = { unit = "Pa/m^3", value = 2.3e11, free = true }
Kq = { unit = "m^3/s", value = 3.9e-4, free = true }
Kc = { unit = "m^3/s/Pa", value = 1.3e-10, free = true }
[equations]
v = "(A*p - k*x - b*v)/m"
p = "C*(Kq*u - A*v - Kc*p)"
[outputs]
x = { unit = "m", noise = 0.001 }
p = { unit = "Pa", noise = 1e4 }
)toml";

/// A valve-controlled cylinder against a spring, whose valve is not where the model has its zero. Euler steps of 0.1 ms.
Signals cylinder(double valve_offset, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "cylinder";
  s.measured = {{"x", "m", {}, 0.0}, {"p", "Pa", {}, 0.0}};
  s.inputs = {{"u", "-", {}, 0.0}};
  const auto valve = [](double t) { return 0.4 * std::sin(0.9 * t) + 0.35 * std::sin(2.1 * t + 1.0) + 0.2 * std::sin(3.7 * t); };
  double x = 0.0, v = 0.0, p = 0.0;
  constexpr double step = 0.011, h = 1e-4;
  constexpr int parts = 110;
  for (std::size_t i = 0; i < 1400; ++i) {
    const double t = step * static_cast<double>(i);
    s.t.push_back(t);
    s.inputs[0].values.push_back(valve(t));
    s.measured[0].values.push_back(x + 4e-4 * normal(random));
    s.measured[1].values.push_back(p + 5e3 * normal(random));
    for (int k = 0; k < parts; ++k) {
      const double force = (1.13e-3 * p - 10500.0 * x - 570.0 * v) / 44.0;
      const double flow = 2.82e-4 * (valve(t + h * k) + valve_offset) - 1.13e-3 * v - 1.25e-10 * p;
      x += h * v;
      v += h * force;
      p += h * 2e11 * flow;
    }
  }
  return s;
}

/// What the regression makes of a noisy pressure and a model without the offset is a compressibility below 0.
TEST(FilterErrorOfADeclaredSystem, BeginsAtTheStudysValuesTooWhereTheRegressionChangesASign) {
  const auto known = registry_with(cylinder_text);
  const Model model = assemble(request_of("text"), *known);
  const std::vector<Signals> experiments = {cylinder(-0.026, 1)};
  const int C = model.find_parameter("C");
  const FittedModel regressed = equation_error(model, experiments);
  ASSERT_LT(regressed.model.parameters[C].value, 0.0) << "another recording is needed";
  const Estimation found = estimator("filter_error").run({.model = model, .experiments = experiments});
  ASSERT_TRUE(found.filter);
  const Parameter& compressibility = found.filter->model.parameters[C];
  EXPECT_GT(compressibility.value, 1e11);
  EXPECT_LT(compressibility.value, 4e11);
}

}  // namespace
}  // namespace misfit
