#pragma once

// A motor that is driven to and fro, and a sensor that reads how fast it turns, not which way.

#include <cmath>
#include <random>

#include "misfit/data/signals.h"

namespace misfit::testing_rectified {

inline constexpr double tau = 0.3, gain = 6.0;  // [s], [rad/s/V]

/// tau w' = gain U − w from w0, exact between samples of 20 ms; U held for a time between 0.2 s and 1.2 s. Read as |w| where `size_alone`.
inline Signals motor(bool size_alone, double w0, unsigned seed, double noise = 0.5) {
  constexpr double step = 0.02;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  Signals s;
  s.name = "motor";
  s.measured = {{"w", "rad/s", {}, 0.0}};
  s.inputs = {{"U", "V", {}, 0.0}};
  double w = w0, voltage = 0.0, until = 0.0;
  for (int k = 0; k < 800; ++k) {
    const double t = step * k;
    if (t >= until) {
      voltage = 20.0 * uniform(random) - 10.0;
      until = t + 0.2 + uniform(random);
    }
    s.t.push_back(t);
    s.inputs[0].values.push_back(voltage);
    s.measured[0].values.push_back((size_alone ? std::abs(w) : w) + noise * normal(random));
    w = gain * voltage + (w - gain * voltage) * std::exp(-step / tau);
  }
  return s;
}

}  // namespace misfit::testing_rectified
