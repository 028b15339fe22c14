#pragma once

#include <map>
#include <string>

#include "misfit/core/config.h"
#include "misfit/data/calibration.h"

namespace misfit {

/// A camera from a study's numbers instead of a sweep: [camera] h_c = {…}, K = {…} and any other of camera_parameter_names, in SI. Those
/// with a sigma are "free" in the result, taken as independent; those without are exact, and a note says so. h_c and K must be there.
/// InputError: an unknown name, h_c or K missing, K not positive, a negative sigma.
[[nodiscard]] Calibration camera_from_study(CameraModel model, const std::map<std::string, config::Number>& given);

}  // namespace misfit
