#pragma once

#include <cmath>

namespace misfit {

/// −log of the normal density of an innovation e of variance S > 0: ½ (log 2π + log S + e²/S), in the units of e.
[[nodiscard]] inline double minus_log_normal(double e, double S) {
  constexpr double log_two_pi = 1.8378770664093453;
  return 0.5 * (log_two_pi + std::log(S) + e * e / S);
}

}  // namespace misfit
