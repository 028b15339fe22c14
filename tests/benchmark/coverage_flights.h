#pragma once

// Flights whose truth is known, for the bench of intervals.

#include <string>
#include <vector>

#include "misfit/data/signals.h"
#include "misfit/model/model.h"

namespace misfit::bench {

/// One flight: what was simulated and what is to be estimated.
struct CoverageFlight {
  Signals signals;
  ModelRequest request;                ///< of the model that is fitted; its curves still need knots
  Model truth;                         ///< what was simulated
  double trim = 0.0;                   ///< [rad]
  std::vector<double> angles;          ///< [rad] five, at 10, 30, 50, 70 and 90 % of the visited angles of attack
  std::vector<std::string> free;       ///< parameters beside the curves
  double force = 0.0, force_time = 0;  ///< of the random force; 0: none
};

/// Kinds of flight: "white" and "coloured" are limit cycles of the planar parachute (the paper's Eq. 8) about a trim of 10.5 to 13.5 deg
/// with a line of 3 to 6 N m at a frequency that is estimated too, alpha_T read with noise of 0.1 deg: white, or a resonance at 8 to 10 Hz
/// (damping 0.1) of 0.1 deg and 0.03 deg of white. "forced": the spherical parachute in gusts of 27 N m and 0.1 s, lateral damping free, in
/// pixels with 1 px of 9 Hz jitter and 0.5 px of white noise. C_m and damping bend as the fits' roughness takes curves to (C'' is white
/// noise: only of such curves can a band be expected to hold 95 of 100; of smoother ones it holds more). Curves, phases and strengths
/// differ from flight to flight; the same (kind, number, seconds) give the same flight.
[[nodiscard]] CoverageFlight draw_flight(const std::string& kind, int number, double seconds, const Registry& registry);

}  // namespace misfit::bench
