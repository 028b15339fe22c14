// Where the recording begins in the middle of a motion, the filter's first states are as uncertain as the motion is wide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "misfit/fit/filter/filter_estimate.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;

constexpr double step = 0.02, true_tau = 0.27, true_lag = 0.15, true_gain = 9.4;

/// A motor's speed [rad/s] behind a sensor with inertia, driven by steps of voltage; `unit`: what a unit of the recorded speed is worth.
/// The steps before the recording count, and are not in it.
Signals motor(double unit) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> volts(-12.0, 12.0);
  Signals s;
  s.name = "motor";
  s.measured = {{"w", "rad/s", {}, 0.0}};
  s.inputs = {{"U", "V", {}, 0.0}};
  double w = 0.0, shown = 0.0, u = 0.0;
  constexpr int before = 53, parts = 20;
  for (int i = -before; i < 600; ++i) {
    if ((i + before) % 25 == 0) u = volts(random);
    if (i >= 0) {
      s.t.push_back(step * i);
      s.measured[0].values.push_back((shown + 0.3 * normal(random)) / unit);
      s.inputs[0].values.push_back(u);
    }
    for (int k = 0; k < parts; ++k) {
      const double h = step / parts, before_step = w, level = true_gain * u;
      w = level + (w - level) * std::exp(-h / true_tau);
      shown += (0.5 * (before_step + w) - shown) * -std::expm1(-h / true_lag);
    }
  }
  return s;
}

std::string speed(const std::string& gain, const std::string& noise) {
  return R"toml([states]
w = { unit = "rad/s" }
[inputs]
U = { unit = "V", hold = "zero_order" }
[parameters]
tau = { unit = "s", value = 0.3, free = true }
gain = { unit = "rad/s/V", value = )toml" +
         gain + R"toml(, free = true }
[ports]
torque = { unit = "rad/s^2", rate = "w" }
[equations]
w = "(gain*U - w)/tau + torque"
[outputs]
w = { unit = "rad/s", noise = )toml" +
         noise + " }\n";
}

FilterEstimate fitted(const EffectRequest& lag, const std::map<std::string, ParameterRequest>& parameters, double unit = 1.0) {
  const auto known = registry_with(speed(std::to_string(9.0 / unit), std::to_string(0.3 / unit)));
  ModelRequest request = request_of("text", {lag});
  request.parameters = parameters;
  return estimate_filter(assemble(request, *known), {}, {motor(unit)});
}

ParameterRequest start(double value, std::optional<bool> free = {}) {
  ParameterRequest out;
  out.value = value;
  out.free = free;
  return out;
}

FilterEstimate behind_sensor(double unit = 1.0) {
  return fitted(effect("sensor_lag", {{"output", "w"}}), {{"share", start(1.0, false)}, {"sensor_tau", start(0.2)}}, unit);
}

/// Mean square of the first innovations over their variances.
double squares_of_first(const FilterEstimate& estimate, std::size_t count) {
  const std::size_t first = estimate.data[0].first;
  double sum = 0.0;
  for (std::size_t k = first; k < first + count; ++k) sum += std::pow(estimate.traces[0].e[k], 2) / estimate.traces[0].S[k];
  return sum / static_cast<double>(count);
}

TEST(StartOfStates, BehindASensorWithInertiaIsNotWhatItShows) {
  const FilterEstimate lag = behind_sensor();
  EXPECT_LT(squares_of_first(lag, 20), 2.0) << "the speed is some rad/s from what the sensor shows";
  const auto value = [&](const char* name) {
    const auto& all = lag.model.parameters;
    return std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.name == name; })->value;
  };
  const auto [shorter, longer] = std::minmax({value("tau"), value("sensor_tau")});  // which is which nobody can tell
  EXPECT_NEAR(shorter, true_lag, 0.002);
  EXPECT_NEAR(longer, true_tau, 0.0025) << "three sigmas of each";
}

TEST(StartOfStates, DoesNotDependOnTheUnitOfTheState) {
  const FilterTrace one = behind_sensor().traces[0], thousandth = behind_sensor(1000.0).traces[0];
  EXPECT_NEAR(one.loglik, thousandth.loglik - static_cast<double>(one.counted) * std::log(1000.0), 0.01);
}

/// Of a linear system nobody can tell which of two lags comes first, so neither may fit better.
TEST(StartOfStates, OneLagBehindAnotherFitsAsWellAsOneBefore) {
  const FilterEstimate before = fitted(effect("input_lag", {{"port", "torque"}}), {{"input_tau", start(0.2)}});
  EXPECT_NEAR(before.traces[0].loglik, behind_sensor().traces[0].loglik, 3.0);
}

}  // namespace
}  // namespace misfit
