// A log whose sensors each have a clock of their own: two masses on springs, six channels at 1000, 250, 50 and 5 Hz with jitter.
#include <gtest/gtest.h>
#include <misfit_models_registry.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "misfit/misfit.h"
#include "tests/core/temporary_folder.h"

namespace {

using namespace misfit;

struct Sample {
  double t, value;
};
using Topics = std::map<std::string, std::vector<Sample>>;

/// PX4's ULog: each topic is { uint64_t timestamp [us]; double value; }.
class ULogWriter {
 public:
  std::string write(const Topics& topics) {
    text_ = std::string("\x55\x4c\x6f\x67\x01\x12\x35\x01", 8);
    put(std::uint64_t{0});
    message('B', std::string(40, '\0'));
    std::uint16_t id = 0;
    std::vector<std::pair<double, std::string>> data;
    for (const auto& [name, samples] : topics) message('F', name + ":uint64_t timestamp;double value;");
    for (const auto& [name, samples] : topics) {
      const std::string bytes = of(id);
      message('A', std::string(1, '\0') + bytes + name);
      for (const Sample& s : samples) data.emplace_back(s.t, bytes + of(static_cast<std::uint64_t>(std::llround(1e6 * s.t))) + of(s.value));
      ++id;
    }
    std::stable_sort(data.begin(), data.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [t, bytes] : data) message('D', bytes);
    return text_;
  }

 private:
  template <class Number>
  static std::string of(Number number) {
    std::string out(sizeof number, '\0');
    std::memcpy(out.data(), &number, sizeof number);
    return out;
  }
  template <class Number>
  void put(Number number) {
    text_ += of(number);
  }
  void message(char type, const std::string& payload) {
    put(static_cast<std::uint16_t>(payload.size()));
    text_ += type + payload;
  }
  std::string text_;
};

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

class SeveralClocks {
 public:
  explicit SeveralClocks(const Topics& topics) {
    misfit_models_register(registry_);
    folder_.write("log.ulg", ULogWriter().write(topics));
    folder_.write("m.toml", R"toml([system]
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
)toml");
    folder_.write("study.toml", R"toml([study]
name = "log"
question = "What is missing?"
methods = ["equation_error", "output_error", "filter_error"]
seed = 1
[system]
file = "m.toml"
[[experiment]]
name = "one"
data = "log.ulg"
columns = { x1 = "x1.value", v1 = "v1.value", x2 = "x2.value", v2 = "v2.value", sum = "sum.value", force = "force.value" }
)toml");
  }

  [[nodiscard]] Identification identification(const std::string& method) {
    const std::string study = (folder_.path() / "study.toml").string(), out = (folder_.path() / "out").string();
    return Identification({.study = study, .out = out, .methods = {method}}, registry_);
  }

 private:
  TemporaryFolder folder_;
  Registry registry_;
};

const std::map<std::string, double> truth = {{"k1", k1}, {"k2", k2}, {"c1", c1}, {"c2", c2}};

void expect_right(const Topics& log, const std::string& method, double sigma_of_k1) {
  const Fit fit = SeveralClocks(log).identification(method).fit(method);
  ASSERT_TRUE(fit.parameters.contains("k1")) << method << ": " << fit.message;
  for (const auto& [name, value] : truth) {
    const Estimate& estimate = fit.parameters.at(name);
    EXPECT_NEAR(estimate.value, value, 3.0 * estimate.sigma) << method << ", " << name << " ± " << estimate.sigma;
  }
  EXPECT_LT(fit.parameters.at("k1").sigma, sigma_of_k1) << method;
}

TEST(ALogOfSeveralClocks, IsFittedWithMeasurementsAtTheirOwnTimes) {
  const Topics log = recording(5, 4.0);
  expect_right(log, "equation_error", 2.0);
  expect_right(log, "output_error", 0.04);
  expect_right(recording(6, 1.2), "filter_error", 0.2);
}

}  // namespace
