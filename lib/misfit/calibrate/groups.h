#pragma once

#include <string>
#include <vector>

namespace misfit {

/// An optional part of the camera: its parameters are tested and selected together.
struct CameraGroup {
  std::string name;                     ///< "image_centre"
  std::vector<std::size_t> parameters;  ///< indices into camera_parameter_names
};

/// Index of a name in camera_parameter_names. InputError naming the nearest.
[[nodiscard]] std::size_t camera_parameter(const std::string& name);

/// The group called `name`, without what a sweep lacking P_y cannot show: nothing is left of camera_roll and pixel_aspect then, and of
/// image_centre centre_z. InputError naming the nearest.
[[nodiscard]] CameraGroup camera_group(const std::string& name, bool with_y);

}  // namespace misfit
