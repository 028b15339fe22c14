#pragma once

#include <vector>

#include "misfit/data/geometry.h"
#include "misfit/data/sweep.h"

namespace misfit {

/// One reference point at one angle, in the rig's frame and in the image.
struct SweepPoint {
  int point = 0;            ///< 1, 2, 3
  double theta = 0.0;       ///< [rad]
  double x = 0.0, z = 0.0;  ///< [m], x downstream of the backshell face; y = 0
  double P_y = 0.0;         ///< [px]; NaN = not measured
  double P_z = 0.0;         ///< [px]; NaN = not measured
};

/// All points of which at least one coordinate was measured, angle by angle. Throws RunError where fewer than three different angles carry
/// data, InputError where the geometry puts a point at or behind the camera.
[[nodiscard]] std::vector<SweepPoint> sweep_points(const Sweep& sweep, const RigGeometry& geometry);

/// Does any point carry P_y?
[[nodiscard]] bool has_y(const std::vector<SweepPoint>& points);

}  // namespace misfit
