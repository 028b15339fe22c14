#pragma once

// References
//   [P]  Parachute Aerodynamics from Video Data ("the paper"; lib/misfit/README.md, [1]).

#include <map>
#include <string>
#include <vector>

#include "misfit/data/calibration.h"
#include "misfit/data/geometry.h"
#include "misfit/data/sweep.h"

namespace misfit {

/// Optional camera parameters that may be estimated from a sweep, each with the parameters it frees ("image_centre": centre_y, centre_z).
[[nodiscard]] const std::vector<std::string>& optional_camera_parameters();

struct CalibrateOptions {
  CameraModel model = CameraModel::pinhole;                            ///< passed on; the rig's points project alike under both
  std::vector<std::string> candidates = optional_camera_parameters();  ///< freed only where the sweep supports them
  std::vector<std::string> force;                                      ///< freed whatever the test says
  std::map<std::string, double> fixed;  ///< values of camera_parameter_names that stay where they are not freed, SI
  bool test_others = true;              ///< those neither offered nor freed: significant ones are noted, at the price of a second fit
  double threshold = 1e-3;              ///< corrected p-value below which a candidate is selected
  double outlier_limit = 4.0;           ///< a point farther off than this many robust sigmas, in either coordinate, is set aside
};

/// Camera parameters from the static sweep [P, Eqs. 5-7, both image coordinates].
///
/// h_c and K are always free. The points to keep are found by a robust fit (Cauchy) with all candidates free, so that a point is not called
/// wild for a parameter that is not in yet; then every fit is plain least squares on the points kept, its covariance s² (J'J)⁻¹ with s² =
/// RSS/(coordinates kept − free parameters). It assumes: the rig's angles and lengths are exact, noise is white and equal in y and z. An
/// candidate is selected, best first, if its F-test against the model so far has p < threshold after Šidák's correction for the
/// number of candidates and its estimate is inside wide physical bounds; those selected are tested again at the end.
///
/// Throws InputError (unknown parameter name, impossible geometry) and RunError (fewer than three angles, too few data, a sweep that does
/// not determine what is asked for), in words. A solver that stopped early is Calibration::converged = false with its message.
[[nodiscard]] Calibration calibrate(const Sweep& sweep, const RigGeometry& geometry, const CalibrateOptions& options = {});

}  // namespace misfit
