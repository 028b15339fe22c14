#pragma once

// References
//   [P]  Parachute Aerodynamics from Video Data ("the paper"; lib/misfit/README.md, [1]).

#include <cmath>

namespace misfit {

/// [P, Eq. 4] alpha_T = acos(cos alpha cos beta) [rad], in a form that is exact near zero: with a = sin²(alpha/2), b = sin²(beta/2),
/// sin²(alpha_T/2) = a + b − 2ab and cos²(alpha_T/2) = (1 − a)(1 − b) + ab.
inline double total_angle(double alpha, double beta) {
  const double a = std::sin(alpha / 2.0) * std::sin(alpha / 2.0);
  const double b = std::sin(beta / 2.0) * std::sin(beta / 2.0);
  return 2.0 * std::atan2(std::sqrt(a + b - 2.0 * a * b), std::sqrt((1.0 - a) * (1.0 - b) + a * b));
}

/// Clock angle of the axis, atan2(n_y, n_z) [rad]: zero at psi = 0 and theta > 0. 0 where it is undefined (theta = psi = 0).
inline double clock_angle(double theta, double psi) { return std::atan2(std::cos(theta) * std::sin(psi), std::sin(theta) * std::cos(psi)); }

/// [P, Eqs. 2 and 3] angle + (R_cp cos angle / V) rate: what the wind makes with the axis in one plane [rad]; lag = R_cp / V [s].
inline double wind_angle(double angle, double rate, double lag) { return angle + lag * std::cos(angle) * rate; }

}  // namespace misfit
