// A log whose sensors each have a clock of their own: two masses on springs, six channels at 1000, 250, 50 and 5 Hz with jitter.
#include <gtest/gtest.h>
#include <misfit_models_registry.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "misfit/misfit.h"
#include "tests/core/temporary_folder.h"
#include "tests/core/ulog_writer.h"

namespace {

using namespace misfit;

struct Sample {
  double t, value;
};
using Topics = std::map<std::string, std::vector<Sample>>;

std::string written(const Topics& topics) {
  UlogWriter log;
  std::uint16_t number = 0;
  for (const auto& [name, samples] : topics) log.topic(number++, name, "double value;");
  number = 0;
  for (const auto& [name, samples] : topics) {
    for (const Sample& s : samples) log.record(number, s.t, s.value);
    ++number;
  }
  return log.text();
}

constexpr double k1 = 30.0, k2 = 20.0, c1 = 0.4, c2 = 0.3;

/// Each sensor: rate [Hz], noise, what it measures of x1, v1, x2, v2.
struct Sensor {
  const char* name;
  double rate, noise;
  std::array<double, 4> row;
};
constexpr std::array<Sensor, 5> sensors = {{{"x1", 250.0, 0.004, {1, 0, 0, 0}},
                                            {"v1", 1000.0, 0.05, {0, 1, 0, 0}},
                                            {"x2", 50.0, 0.004, {0, 0, 1, 0}},
                                            {"v2", 250.0, 0.05, {0, 0, 0, 1}},
                                            {"sum", 5.0, 0.001, {1, 0, 1, 0}}}};

/// By midpoint steps of 0.1 ms; unit masses, the force on the second held between its samples.
Topics recording(unsigned seed, double last) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Topics out;
  std::array<double, sensors.size()> next{};
  for (std::size_t s = 0; s < sensors.size(); ++s) next[s] = (1.3 + 0.3 * uniform(random)) / sensors[s].rate;
  std::array<double, 4> x = {0.5, 0.0, -0.3, 0.0};
  double force = 0.0, next_force = 0.0;
  constexpr double h = 1e-4;
  for (int step = 0; step * h < last; ++step) {
    const double t = step * h;
    if (t >= next_force) {
      if (out["force"].size() % 20 == 0) force = 2.0 * uniform(random);
      out["force"].push_back({t, force});
      next_force = t + (1.0 + 0.2 * uniform(random)) / 100.0;
    }
    for (std::size_t s = 0; s < sensors.size(); ++s) {
      if (t < next[s]) continue;
      double value = sensors[s].noise * normal(random);
      for (std::size_t j = 0; j < x.size(); ++j) value += sensors[s].row[j] * x[j];
      out[sensors[s].name].push_back({t, value});
      next[s] = t + (1.0 + 0.2 * uniform(random)) / sensors[s].rate;
    }
    const auto rates = [&](const std::array<double, 4>& y) {
      return std::array<double, 4>{y[1], -k1 * y[0] - c1 * y[1] + k2 * (y[2] - y[0]), y[3], -k2 * (y[2] - y[0]) - c2 * y[3] + force};
    };
    const auto begin = rates(x);
    std::array<double, 4> middle{};
    for (std::size_t j = 0; j < x.size(); ++j) middle[j] = x[j] + 0.5 * h * begin[j];
    const auto slope = rates(middle);
    for (std::size_t j = 0; j < x.size(); ++j) x[j] += h * slope[j];
  }
  return out;
}

constexpr const char* two_masses = R"toml([system]
doc = "two masses on springs"
[states]
x1 = { unit = "m" }
v1 = { unit = "m/s" }
x2 = { unit = "m" }
v2 = { unit = "m/s" }
[inputs]
force = { unit = "m/s^2", hold = "zero_order" }
[parameters]
k1 = { unit = "1/s^2", value = 20.0, free = true }
k2 = { unit = "1/s^2", value = 10.0, free = true }
c1 = { unit = "1/s", value = 0.1, free = true }
c2 = { unit = "1/s", value = 0.1, free = true }
[equations]
x1 = "v1"
v1 = "-k1*x1 - c1*v1 + k2*(x2 - x1)"
x2 = "v2"
v2 = "-k2*(x2 - x1) - c2*v2 + force"
[outputs]
x1 = { unit = "m", noise = 0.01 }
v1 = { unit = "m/s", noise = 0.1 }
x2 = { unit = "m", noise = 0.01 }
v2 = { unit = "m/s", noise = 0.1 }
sum = { unit = "m", formula = "x1 + x2", noise = 0.01 }
)toml";

constexpr const char* pendulum = R"toml([system]
doc = "a pendulum seen from the front"
[states]
theta = { unit = "rad" }
rate = { unit = "rad/s" }
[parameters]
stiffness = { unit = "1/s^2", value = 10.0, free = true }
damping = { unit = "1/s", value = 0.1, free = true }
L = { unit = "m", value = 0.5 }
[equations]
theta = "rate"
rate = "-stiffness*sin(theta) - damping*rate"
[outputs]
x = { unit = "m", formula = "L*sin(theta)", noise = 0.01 }
y = { unit = "m", formula = "-L*cos(theta)", noise = 0.01 }
)toml";

Fit fitted(const std::string& system, const Topics& topics, const std::string& method, const std::string& effects = "") {
  const TemporaryFolder folder;
  Registry registry;
  misfit_models_register(registry);
  folder.write("log.ulg", written(topics));
  folder.write("m.toml", system);
  std::string columns;
  for (const auto& [name, samples] : topics) columns += (columns.empty() ? "" : ", ") + name + " = \"" + name + ".value\"";
  folder.write("study.toml",
               "[study]\nname = \"log\"\nquestion = \"What is missing?\"\nmethods = [\"" + method +
                   "\"]\nseed = 1\n[system]\nfile = \"m.toml\"\n[[experiment]]\nname = \"one\"\ndata = \"log.ulg\"\ncolumns = { " +
                   columns + " }\n" + effects);
  const std::string study = (folder.path() / "study.toml").string(), out = (folder.path() / "out").string();
  return Identification({.study = study, .out = out, .methods = {method}}, registry).fit(method);
}

using Truth = std::map<std::string, double>;

void expect_right(const Fit& fit, const Truth& truth, const std::string& method) {
  for (const auto& [name, value] : truth) {
    ASSERT_TRUE(fit.parameters.contains(name)) << method << ": " << fit.message;
    const Estimate& estimate = fit.parameters.at(name);
    EXPECT_NEAR(estimate.value, value, 3.0 * estimate.sigma) << method << ", " << name << " ± " << estimate.sigma;
  }
}

TEST(ALogOfSeveralClocks, IsFittedWithMeasurementsAtTheirOwnTimes) {
  const Truth truth = {{"k1", k1}, {"k2", k2}, {"c1", c1}, {"c2", c2}};
  const auto expect = [&](const Topics& log, const std::string& method, double sigma_of_k1) {
    const Fit fit = fitted(two_masses, log, method);
    expect_right(fit, truth, method);
    EXPECT_LT(fit.parameters.at("k1").sigma, sigma_of_k1) << method;
  };
  const Topics log = recording(5, 4.0);
  expect(log, "equation_error", 2.0);
  expect(log, "output_error", 0.04);
  expect(recording(6, 1.2), "filter_error", 0.2);
}

/// The second position is stamped 30 ms before it was measured, and its clock runs 0.4 % slow: by the truth's other three parameters
/// nothing moves.
TEST(ALogOfSeveralClocks, WithAnEarlyClockGivesItsOffsetAndRate) {
  Topics log = recording(7, 2.0);
  constexpr double offset = 0.03, rate = 0.004;
  for (Sample& s : log.at("x2")) s.t = (s.t - offset) / (1.0 + rate);
  const Fit fit = fitted(two_masses, log, "output_error", "[effects]\nsensor_clock = { time_of_output = \"sample_time_x2\" }\n");
  expect_right(fit, {{"k1", k1}, {"k2", k2}, {"c1", c1}, {"c2", c2}, {"sensor_offset", offset}, {"clock_rate", rate}}, "output_error");
  EXPECT_LT(fit.parameters.at("sensor_offset").sigma, 1e-3);
  EXPECT_LT(fit.parameters.at("clock_rate").sigma, 1e-3);
  const Fit blind = fitted(two_masses, log, "output_error");
  EXPECT_GT(blind.rms.at("x2").value, 3.0 * fit.rms.at("x2").value) << "without it the sensor is 30 ms of some 0.5 m/s off";
}

constexpr double stiffness = 19.6, damping = 0.15;

/// Two sensors of one rate, 250 Hz, the second so many steps of 50 us behind the first, by midpoint steps: no angle can be read from one of
/// them alone without knowing the sign of the other.
Topics pendulum_seen(int behind) {
  constexpr double h = 5e-5;
  std::mt19937 random(8);
  std::normal_distribution<double> noise(0.0, 0.002);
  Topics out;
  double theta = 1.0, rate = 0.0;
  for (int step = 0; step < 120000; ++step) {
    if (step % 80 == 0) out["x"].push_back({step * h, 0.5 * std::sin(theta) + noise(random)});
    if (step % 80 == behind) out["y"].push_back({step * h, -0.5 * std::cos(theta) + noise(random)});
    const double middle = theta + 0.5 * h * rate, middle_rate = rate + 0.5 * h * (-stiffness * std::sin(theta) - damping * rate);
    theta += h * middle_rate;
    rate += h * (-stiffness * std::sin(middle) - damping * middle_rate);
  }
  return out;
}

TEST(ALogOfSeveralClocks, OfOneRateIsFittedAsIfItsSensorsWereReadTogether) {
  for (const char* method : {"equation_error", "output_error", "filter_error"}) {
    const Fit apart = fitted(pendulum, pendulum_seen(1), method), together = fitted(pendulum, pendulum_seen(0), method);
    expect_right(apart, {{"stiffness", stiffness}, {"damping", damping}}, method);
    expect_right(together, {{"stiffness", stiffness}, {"damping", damping}}, method);
    for (const char* name : {"stiffness", "damping"})
      EXPECT_LT(apart.parameters.at(name).sigma, 1.25 * together.parameters.at(name).sigma) << method << ", " << name;
  }
}

}  // namespace
