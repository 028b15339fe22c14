#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace misfit {

/// Adds multiples of a full turn so that neighbours differ by less than half a turn [rad]; missing values (NaN) stay missing.
[[nodiscard]] inline std::vector<double> unwrapped(std::vector<double> angle) {
  constexpr double turn = 2.0 * std::numbers::pi;
  double turns = 0.0, last = std::numeric_limits<double>::quiet_NaN();
  for (double& a : angle) {
    if (!std::isfinite(a)) continue;
    if (std::isfinite(last)) turns -= std::round((a + turns - last) / turn) * turn;
    a += turns;
    last = a;
  }
  return angle;
}

}  // namespace misfit
