#pragma once

// x' = −a x, given as text, and its records.

#include <cmath>
#include <random>
#include <string>

#include "misfit/data/signals.h"
#include "tests/model/declared_texts.h"

namespace misfit::testing_decay {

using namespace testing_models;

inline const std::string decay_text = R"toml(
[states]
x = { unit = "V", scale = 1.0 }
[parameters]
a = { unit = "1/s", value = 0.5, bounds = [0.0, 100.0], free = true }
[equations]
x = "-a*x"
[outputs]
y = { unit = "V", formula = "x", noise = 0.01 }
)toml";

inline constexpr double truth = 1.0, noise = 0.01, duration = 3.0;

/// exp(−t) over three seconds with white noise.
inline Signals decay(std::size_t samples, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "decay";
  s.measured = {{"y", "V", {}, 0.0}};
  for (std::size_t i = 0; i < samples; ++i) {
    s.t.push_back(duration * static_cast<double>(i) / static_cast<double>(samples));
    s.measured[0].values.push_back(std::exp(-truth * s.t.back()) + noise * normal(random));
  }
  return s;
}

}  // namespace misfit::testing_decay
