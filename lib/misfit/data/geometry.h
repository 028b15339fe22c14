#pragma once

namespace misfit {

/// Lengths of rig, parachute and camera [m] and the flow, as a camera and its angles need them. x is measured from the backshell face.
struct RigGeometry {
  double R = 0.0;     ///< swivel → apex [m]
  double R_cp = 0.0;  ///< swivel → centre of pressure [m]
  double V = 0.0;     ///< free stream [m/s]
  double l_b = 0.0;   ///< backshell face → camera, along x [m]
  double l_s = 0.0;   ///< swivel → camera, along x [m]
  double l_p = 0.0;   ///< backshell face → pivot of the static rig, along x [m]
  double R1 = 0.0;    ///< pivot → reference point 1 [m]
  double R2 = 0.0;    ///< pivot → reference point 2 [m]
  double R3 = 0.0;    ///< pivot → reference point 3 [m]
};

}  // namespace misfit
