// Where the recording begins in the middle of a motion, the filter's first states are as uncertain as the motion is wide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "misfit/fit/filter/filter_estimate.h"
#include "misfit/fit/filter/filter_start.h"
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

/// A cell whose voltage, behind a sensor with inertia, is all that is recorded: charge and sensor begin unknown.
struct Cell {
  Cell()
      : systems(registry_with(R"toml([states]
soc = { unit = "-", initial = { kind = "free", value = 0.5 } }
V1 = { unit = "V", scale = 0.05 }
[inputs]
I = { unit = "A", hold = "zero_order" }
[parameters]
Q = { unit = "A s", value = 7500.0 }
E0 = { unit = "V", value = 3.3 }
E1 = { unit = "V", value = 0.9, free = true }
R0 = { unit = "V/A", value = 0.01, free = true }
R1 = { unit = "V/A", value = 0.02 }
tau1 = { unit = "s", value = 48.0 }
[ports]
leak = { unit = "1/s", rate = "soc" }
[equations]
soc = "-I/Q + leak"
V1 = "(R1*I - V1)/tau1"
[outputs]
V = { unit = "V", formula = "E0 + E1*soc - R0*I - V1", noise = 0.001 }
)toml")) {
    signals.name = "cell";
    signals.measured = {{"V", "V", {}, 0.0}};
    signals.inputs = {{"I", "A", {}, 0.0}};
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    double soc = 0.9, V1 = 0.0, shown = 4.05, current = 0.0;
    for (int k = -50; k < 400; ++k) {
      if (k % 20 == 0) current = 3.0 * normal(random);
      if (k >= 0) {
        signals.t.push_back(step * k);
        signals.measured[0].values.push_back(shown + 0.001 * normal(random));
        signals.inputs[0].values.push_back(current);
      }
      for (int part = 0; part < 50; ++part) {
        const double h = step / 50.0, before = 0.9 * soc - V1;
        soc -= h * current / 7500.0;
        V1 += (0.02 * current - V1) * -std::expm1(-h / 48.0);
        shown += (3.3 + 0.5 * (before + 0.9 * soc - V1) - 0.01 * current - shown) * -std::expm1(-h / lag);
      }
    }
  }

  static constexpr double step = 5.0, lag = 20.0;
  std::shared_ptr<Registry> systems;
  Signals signals;
};

TEST(StartOfStates, OfASensorThatFollowsAHiddenStateIsAsUncertainAsThat) {
  const Cell cell;
  ModelRequest request = request_of("text", {effect("sensor_lag", {{"output", "V"}})});
  request.parameters = {{"share", start(1.0, false)}, {"sensor_tau", start(10.0)}};
  const FilterEstimate estimate = estimate_filter(assemble(request, *cell.systems), {}, {cell.signals});
  const Eigen::MatrixXd& P = estimate.data[0].covariance;
  EXPECT_NEAR(P(0, 0), 0.25, 1e-12) << "half the range of the charge, squared";
  const auto& parameters = estimate.model.parameters;
  const auto E1 = std::find_if(parameters.begin(), parameters.end(), [](const Parameter& p) { return p.name == "E1"; });
  EXPECT_NEAR(P(2, 0), E1->value * 0.25, 1e-5) << "dV/dsoc = E1, as it was estimated before the last steps";
  EXPECT_NEAR(P(2, 1), -0.05 * 0.05, 1e-9) << "dV/dV1 = -1";
  EXPECT_GT(P(2, 2), 0.81 * 0.25 + 0.05 * 0.05);
  EXPECT_LT(squares_of_first(estimate, 5), 3.0) << "the charge is 0.4 from where it is declared to begin";
  const std::map<std::string, double> truth{{"E1", 0.9}, {"R0", 0.01}, {"sensor_tau", Cell::lag}};
  const std::vector<int> free = estimate.model.free_parameters();
  for (Eigen::Index p = 0; p < std::ssize(free); ++p) {
    const Parameter& parameter = estimate.model.parameters[free[p]];
    EXPECT_NEAR(parameter.value, truth.at(parameter.name), 3.0 * std::sqrt(estimate.covariance(p, p))) << parameter.name;
    EXPECT_LT(std::sqrt(estimate.covariance(p, p)), 0.05 * parameter.value) << parameter.name;
  }
}

TEST(UsualNoise, OfAForceOnAHiddenStateIsAsLargeAsTheModelsOwnRates) {
  const Cell cell;
  const FilterModel model = with_random_force(assemble(request_of("text"), *cell.systems));
  const std::vector<FilterData> data{filter_data(model, cell.signals)};
  double squares = 0.0;
  for (const double current : cell.signals.inputs[0].values) squares += std::pow(current / 7500.0, 2) / 400.0;
  EXPECT_NEAR(usual_noise(model, data).force, 0.3 * std::sqrt(squares), 0.05 * std::sqrt(squares)) << "not one unit per second";
}

/// The cart that swings once in two seconds, measured for 40 s.
Signals swinging_cart(double every) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "cart";
  s.inputs = {{"drive", "N", {}}};
  s.measured = {{"position_reading", "-", {}}, {"speed_reading", "m/s", {}}};
  for (int k = 0; every * k < 40.0; ++k) {
    const double t = every * k;
    s.t.push_back(t);
    s.inputs[0].values.push_back(0.0);
    s.measured[0].values.push_back(0.3 * std::cos(3.0 * t) + 0.0005 * normal(random));
    s.measured[1].values.push_back(-0.9 * std::sin(3.0 * t) + 0.02 * normal(random));
  }
  return s;
}

/// Read from neighbours, the acceleration at 5 kHz would be that of the noise, thousands of m/s^2.
TEST(UsualNoise, OfARecordingSampledMuchFasterThanItMovesIsThatOfTheMotion) {
  const FilterModel model = with_random_force(assemble(cart({}), registry()));
  const double force = 0.3 * 2.0 * 2.7 / std::numbers::sqrt2;  // 0.3 mass acceleration, RMS
  for (const double every : {0.05, 0.02, 0.002, 0.0002}) {
    const Signals signals = swinging_cart(every);
    const FilterNoise usual = usual_noise(model, {filter_data(model, signals)});
    EXPECT_GT(usual.force, 0.8 * force) << every;
    EXPECT_LT(usual.force, 2.5 * force) << every;
    EXPECT_GT(usual.force_time, 6.0 * every - 1e-12);
    EXPECT_LT(usual.force_time, 0.4) << "well below the period";
    if (every > 0.01) {
      EXPECT_NEAR(usual.force_time, 6.0 * every, 1e-9) << "nothing is averaged where the motion is seen as it is";
    }
    EXPECT_NEAR(usual.channels[1].white, 0.02, 0.004);
  }
}

TEST(StartOfStates, ThatTheStudyKnowsIsHeldWhereTheRecordingBegins) {
  Signals s = swinging_cart(0.05);
  Model model = assemble(cart({}), registry());
  model.state_specs[0].initial = Initial::fixed;
  model.state_specs[0].start = 0.25;
  const FilterModel forced = with_random_force(model);
  const FilterData known = filter_data(forced, s);
  EXPECT_EQ(known.first, 0U);
  EXPECT_EQ(known.start[0], 0.25);
  EXPECT_EQ(known.covariance(0, 0), 0.0);
  EXPECT_GT(known.covariance(1, 1), 0.0) << "the speed is not known";
  s.after_gap = true;
  const FilterData later = filter_data(forced, s);
  EXPECT_NEAR(later.start[0], 0.3, 0.01) << "of the recording's beginning, not of a part behind a gap";
  EXPECT_GT(later.covariance(0, 0), 0.0);
}

/// u lets the force act: not at the first sample.
TEST(UsualNoise, OfAForceThatDoesNotActAtFirstIsThatOfTheOtherSamples) {
  const auto systems = registry_with(R"toml(
[states]
x = { unit = "m", scale = 0.1 }
v = { unit = "m/s", rate_of = "x", scale = 1.0 }
[inputs]
u = { unit = "-" }
[parameters]
k = { unit = "1/s^2", value = 9.0 }
[ports]
push = { unit = "m/s^2" }
[equations]
x = "v"
v = "-k*x + 0.001*u*push"
[outputs]
x = { unit = "m", noise = 1e-3 }
[roles]
force_ports = ["push"]
)toml");
  const FilterModel model = with_random_force(assemble(request_of("text"), *systems));
  Signals s;
  s.measured = {{"x", "m", {}, 0.0}};
  s.inputs = {{"u", "-", {}, 0.0}};
  for (int k = 0; k < 400; ++k) {
    s.t.push_back(0.05 * k);
    s.measured[0].values.push_back(0.1 * std::cos(3.0 * s.t.back()));
    s.inputs[0].values.push_back(1.0);
  }
  const double always = usual_noise(model, {filter_data(model, s)}).force;
  s.inputs[0].values.front() = 0.0;
  EXPECT_NEAR(usual_noise(model, {filter_data(model, s)}).force, always, 1e-9 * always);
  EXPECT_GT(always, 50.0) << "0.3 of 0.9/sqrt(2) m/s^2 over 0.001";
}

}  // namespace
}  // namespace misfit
