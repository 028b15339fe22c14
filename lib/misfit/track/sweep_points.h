#pragma once

#include <array>
#include <optional>
#include <vector>

#include "misfit/data/image.h"

namespace misfit {

/// Points 1, 2, 3 of the static rig in one picture; nullopt where a point is not seen.
using SweepPoints = std::array<std::optional<PixelPoint>, 3>;

/// Which found marker is which point of the rig. `found[k]`: the markers in the picture at angle theta[k] [rad].
/// Without `first` (about where points 1, 2, 3 are in picture 0) they are identified by the rig's geometry in the picture of the largest
/// |theta| with three markers or more: z1 = R1 sin theta and z3 = −R3 sin theta are on opposite sides of z2, so by row, point 1 is lowest
/// in the picture for theta > 0 and highest for theta < 0. From there on every point is followed through the angles in their order, each
/// expected where the two pictures before let a straight line go on; the assignment with the least sum of squared distances is taken, a
/// marker farther than `reach` px is none. RunError if no picture shows three markers.
[[nodiscard]] std::vector<SweepPoints> assign_sweep_points(const std::vector<double>& theta,
                                                           const std::vector<std::vector<PixelPoint>>& found,
                                                           const std::vector<PixelPoint>& first, double reach = 60.0);

}  // namespace misfit
