#pragma once

// A slide on a spring and a damper, whose position is measured; what acts along its way is each test's own.

#include <random>
#include <string>

#include "misfit/data/signals.h"

namespace misfit::testing_models {

inline const std::string slide_text = R"toml(
[states]
x = { unit = "m", scale = 0.05 }
v = { unit = "m/s", scale = 0.2, rate_of = "x" }
[inputs]
F = { unit = "N", hold = "zero_order" }
[parameters]
k = { unit = "N/m", value = 30.0, free = true }
c = { unit = "N s/m", value = 5.0, free = true }
m = { unit = "kg", value = 2.0 }
[equations]
x = "v"
v = "(F - k*x - c*v)/m"
[outputs]
x = { unit = "m", noise = 2e-4 }
)toml";

/// The same slide of unknown mass: an offset and a scale of x, `gain` and a curve of x as a force cannot be told apart.
inline const std::string slide_of_unknown_mass_text = R"toml(
[states]
x = { unit = "m", scale = 0.05 }
v = { unit = "m/s", scale = 0.2, rate_of = "x" }
[inputs]
F = { unit = "N", hold = "zero_order" }
[parameters]
gain = { unit = "1/kg", value = 0.4, free = true }
k = { unit = "1/s^2", value = 25.0, free = true }
c = { unit = "1/s", value = 3.0, free = true }
[equations]
x = "v"
v = "gain*F - k*x - c*v"
[outputs]
x = { unit = "m", noise = 2e-4 }
)toml";

struct SlideRecord {
  int samples = 1500;
  double force = 4.0;  ///< [N] sigma of F, which jumps every 0.8 s
  unsigned seed = 1;
};

/// k = 40 N/m, c = 8 N s/m; `push(x)` [m/s^2] acts besides. By leapfrog steps of 0.1 ms (the damper by the mean speed over a step), which
/// share nothing with sim/; sampled every 20 ms.
template <class Push>
Signals slide(const SlideRecord& record, const Push& push) {
  constexpr double step = 0.02, fine = 1e-4, half_damping = 0.5 * fine * 8.0 / 2.0;
  std::mt19937_64 random(record.seed);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "slide";
  s.measured = {{"x", "m", {}, 0.0}};
  s.inputs = {{"F", "N", {}, 0.0}};
  double x = 0.0, v = 0.0, force = 0.0;
  for (int n = 0; n < record.samples; ++n) {
    if (n % 40 == 0) force = record.force * normal(random);
    s.t.push_back(step * n);
    s.inputs[0].values.push_back(force);
    s.measured[0].values.push_back(x + 2e-4 * normal(random));
    for (int i = 0; i < 200; ++i) {
      x += 0.5 * fine * v;
      v = (v * (1.0 - half_damping) + fine * ((force - 40.0 * x) / 2.0 + push(x))) / (1.0 + half_damping);
      x += 0.5 * fine * v;
    }
  }
  return s;
}

}  // namespace misfit::testing_models
