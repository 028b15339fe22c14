#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "misfit/calibrate/calibrate.h"
#include "misfit/data/sweep.h"
#include "tests/paths.h"

namespace misfit::sweeps {

/// Rig of all recorded sweeps [m].
inline RigGeometry rig() {
  RigGeometry g;
  g.R = 3.447;
  g.R_cp = 3.15;
  g.V = 35.1;
  g.l_b = 5.69;
  g.l_s = 5.61;
  g.l_p = 0.31;
  g.R1 = 3.447;
  g.R2 = 0.42;
  g.R3 = 2.1;
  return g;
}

/// A recorded sweep and the camera it was recorded with.
struct Recorded {
  const char* name;
  double h_c;  ///< [m]
  double K;    ///< [px/m]
};
inline const std::vector<Recorded>& recorded() {
  static const std::vector<Recorded> all = {
      {"calm", 0.1524, 133.86},   {"mpf_f111", 0.1524, 133.86}, {"null", 0.1524, 133.86},     {"swivel_friction", 0.1524, 133.86},
      {"upwash", 0.1524, 133.86}, {"vortex", 0.1524, 133.86},   {"camera_roll", 0.145, 131.2}};
  return all;
}
inline Sweep read(const std::string& name) { return read_sweep(paths::source() / "tests/data/sweeps" / (name + ".csv")); }

/// Moves a tenth of the points (8 of 75) by 20 px in a random direction each, or all in one direction [rad] if it is not negative.
inline Sweep with_wild_points(Sweep sweep, unsigned seed, double direction = -1.0) {
  std::mt19937 generator(seed);
  std::vector<std::size_t> order(3 * sweep.theta.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (std::size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[generator() % (i + 1)]);
  for (std::size_t k = 0; k < (order.size() + 5) / 10; ++k) {
    const double angle = direction >= 0.0 ? direction : 6.283185307179586 * static_cast<double>(generator()) / 4294967296.0;
    sweep.P_y[order[k] % 3][order[k] / 3] += 20.0 * std::cos(angle);
    sweep.P_z[order[k] % 3][order[k] / 3] += 20.0 * std::sin(angle);
  }
  return sweep;
}

}  // namespace misfit::sweeps
