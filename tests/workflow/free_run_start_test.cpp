// A heated block whose sensor is late: from the start, a random force with a long memory explains all that the model does not explain yet.
#include <gtest/gtest.h>
#include <misfit_models_registry.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "misfit/misfit.h"
#include "tests/core/temporary_folder.h"

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

TEST(AHeatedBlockWithALateSensor, IsFittedByTheFilterNotWorseThanByOutputError) {
  Registry registry;
  misfit_models_register(registry);
  const TemporaryFolder folder;
  folder.write("d.csv", recording());
  folder.write("m.toml", R"([system]
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
)");
  folder.write("study.toml", R"([study]
name = "block"
question = "Is the sensor late?"
methods = ["output_error", "filter_error"]
seed = 1
[system]
file = "m.toml"
[[experiment]]
name = "one"
data = "d.csv"
[effects]
sensor_delay = {}
)");
  Identification identification({.study = (folder.path() / "study.toml").string(), .out = (folder.path() / "out").string()}, registry);
  const Fit freely = identification.fit("output_error"), filtered = identification.fit("filter_error");
  ASSERT_TRUE(freely.loglik && filtered.loglik) << freely.message << filtered.message;
  EXPECT_GT(*filtered.loglik, *freely.loglik - 0.5) << "its model contains that of output error: a random force of 0";
  constexpr double of_the_approximation = 0.3;  // [s] a rational one, seen by a step of the input
  EXPECT_NEAR(filtered.parameters.at("sensor_delay").value, delay, of_the_approximation);
  EXPECT_NEAR(filtered.parameters.at("tau").value, time_constant, 0.6);
  EXPECT_NEAR(filtered.parameters.at("gain").value, gain, 0.6);
}

}  // namespace
