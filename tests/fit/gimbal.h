#pragma once

// An axis with a torsion spring, released from 1 rad, given as text; a moment on it is a port that its author declared.

#include <cmath>
#include <random>
#include <string>

#include "misfit/fit/filter/filter_estimate.h"
#include "tests/model/declared_texts.h"

namespace misfit::testing_gimbal {

using namespace testing_models;

/// `inertia`: what the sum of moments is divided by.
inline std::string gimbal(const std::string& inertia) {
  return R"toml(
[states]
x = { unit = "rad", initial = "free" }
w = { unit = "rad/s", rate_of = "x", initial = "free" }
[parameters]
J = { unit = "kg m^2", value = 0.02 }
b = { unit = "N m s/rad", value = 0.01, free = true }
k = { unit = "N m/rad", value = 0.5, free = true }
[ports]
cable = { unit = "N m" }
[equations]
w = "(cable - b*w - k*x)/)toml" +
         inertia + R"toml("
[outputs]
x = { unit = "rad", noise = 0.01 }
)toml";
}

inline Signals released() {
  std::mt19937_64 random(23);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "gimbal";
  s.measured = {{"x", "rad", {}, 0.0}};
  for (int i = 0; i < 200; ++i) {
    s.t.push_back(0.02 * i);
    s.measured[0].values.push_back(std::exp(-0.25 * s.t.back()) * std::cos(5.0 * s.t.back()) + 0.01 * normal(random));
  }
  return s;
}

inline FilterEstimate estimate_of(const Registry& known) {
  static const std::vector<Signals> signals{released()};  // the estimate points to them
  return estimate_filter(assemble(request_of("text"), known), {}, signals);
}

}  // namespace misfit::testing_gimbal
