#pragma once

// A room that warms up, given as text, its time constant in seconds or in tens of thousands of them.

#include <cmath>
#include <random>
#include <string>

#include "misfit/fit/filter/filter_estimate.h"
#include "tests/model/declared_texts.h"

namespace misfit::testing_room {

using namespace testing_models;

/// A room that warms towards 20 degrees in some hours: the time constant is tau s, or as many times ten thousand of them.
inline std::string warming(const std::string& tau, const std::string& value) {
  return R"toml(
[states]
x = { unit = "K", scale = 1.0 }
[parameters]
tau = { unit = "s", value = )toml" +
         value + R"toml(, free = true }
rest = { unit = "K", value = 15.0, free = true }
[equations]
x = "(rest - x)/()toml" +
         tau + R"toml()"
[outputs]
y = { unit = "K", formula = "x", noise = 0.1 }
)toml";
}

inline constexpr double true_tau = 28000.0, true_rest = 20.0, step = 300.0;

inline Signals room() {
  std::mt19937_64 random(17);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "room";
  s.measured = {{"y", "K", {}, 0.0}};
  for (int i = 0; i < 200; ++i) {
    s.t.push_back(step * i);
    s.measured[0].values.push_back(true_rest * (1.0 - std::exp(-s.t.back() / true_tau)) + 0.1 * normal(random));
  }
  return s;
}

inline FilterEstimate estimate_of(const std::string& text) {
  const auto known = registry_with(text);
  return estimate_filter(assemble(request_of("text"), *known), {}, {room()});
}

}  // namespace misfit::testing_room
