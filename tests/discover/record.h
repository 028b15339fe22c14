#pragma once

// Records of small systems that are not the parachute, simulated with fixed seeds, with effects hidden in them.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "misfit/sim/step.h"
#include "tests/model/requests.h"

namespace misfit::testing_records {

using namespace testing_models;
using Values = std::map<std::string, double>;

/// What comes of an input: its last value and the one that is asked for -> the next.
using Actuator = std::function<double(double, double)>;

/// What the system does with `hidden` in it: an input held at random for 20 samples (recorded as asked for), small random pushes, all
/// states read with white noise.
inline Signals record(const ModelRequest& request, const Values& values, double step, double input, const std::vector<double>& noise,
                      unsigned seed, const Actuator& actuator = {}, std::size_t samples = 2500) {
  Model truth = assemble(request, registry());
  for (const auto& [name, value] : values) set(truth, name, value);
  const SystemSpec& spec = truth.system->spec();
  Signals s;
  s.name = "record";
  for (const auto& i : spec.inputs) s.inputs.push_back({i.name, i.unit, {}});
  for (const auto& o : spec.outputs) s.measured.push_back({o.name, o.unit, {}});
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  constexpr std::size_t held = 20;
  double u = 0.0;
  for (std::size_t k = 0; k < samples; ++k) {
    if (k % held == 0) u = std::abs(input) * (input < 0.0 ? std::abs(normal(random)) : normal(random));
    s.t.push_back(step * static_cast<double>(k));
    s.inputs[0].values.push_back(u);
  }
  std::vector<double> given = s.inputs[0].values;
  for (std::size_t k = 1; actuator && k < samples; ++k) given[k] = actuator(given[k - 1], given[k]);
  Stepper stepper(truth);
  std::vector<double> x(static_cast<std::size_t>(truth.states()), 0.0);
  stepper.prepare(x.data(), given.data(), 0.0);
  for (std::size_t k = 0; k < samples; ++k) {
    for (std::size_t i = 0; i < s.measured.size(); ++i) s.measured[i].values.push_back(x[i] + noise[i] * normal(random));
    if (k + 1 == samples) break;
    EXPECT_TRUE(stepper.step(x.data(), {s.t[k], s.t[k + 1], &given[k], &given[k + 1]}));
    for (std::size_t i = 0; i < noise.size(); ++i) {
      if (spec.states[i].rate_of >= 0 || spec.key == "test_tanks") x[i] += 0.3 * noise[i] * normal(random);
    }
  }
  return s;
}

/// A cart on a spring with viscous friction and what else is asked for.
inline Signals record_of_cart(const std::vector<EffectRequest>& hidden, const Values& values, unsigned seed = 41,
                              const Actuator& actuator = {}, std::size_t samples = 2500) {
  ModelRequest truth = cart({effect("viscous_friction")});
  truth.effects.insert(truth.effects.end(), hidden.begin(), hidden.end());
  Values all = values;
  all["viscosity"] = 1.5;
  return record(truth, all, 0.05, 15.0, {2e-3, 1e-2}, seed, actuator, samples);
}

}  // namespace misfit::testing_records
