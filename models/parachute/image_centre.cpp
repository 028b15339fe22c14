#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The image centre is not where the calibration puts it: all pixels are shifted.
struct ImageCentre {
  static constexpr const char* formula = "P_y = P_y0 + centre_y_error, P_z = P_z0 + centre_z_error";
  static constexpr const char* symbols = "P_y0, P_z0 pixels by the calibrated camera; errors of its centre [px]";
  static constexpr const char* valid = "a camera that does not move during the recording";
  static constexpr const char* size = "10 px (Table 2): 0.47 deg of tilt with K = 134 px/m";
  static constexpr const char* source =
      "Schoenenberger, Queen, Cruz, Parachute Aerodynamics from Video Data, AIAA 2005-1633 (2005), Table 2: P_y, P_z +-10 px, read as 3 "
      "sigma";
  static constexpr const char* excludes =
      "a camera that shakes or drifts; wind that is not along the tunnel axis looks the same (flow_angularity)";
  static constexpr const char* specialises = "bias";  // which would shift P_z without the prior that the calibration gives

  enum Port { P_y, P_z };
  static constexpr Role ports[] = {{.name = "P_y", .unit = "px"}, {.name = "P_z", .unit = "px"}};
  enum Coefficient { centre_y_error, centre_z_error };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "centre_y_error",
       .unit = "px",
       .lower = -1e4,
       .upper = 1e4,
       .scale = 3.0,
       .doc = "shift of P_y beyond the calibration",
       .calibrated_as = "centre_y",
       .prior_sigma = 10.0 / 3.0},
      {.name = "centre_z_error",
       .unit = "px",
       .lower = -1e4,
       .upper = 1e4,
       .scale = 3.0,
       .doc = "shift of P_z beyond the calibration",
       .calibrated_as = "centre_z",
       .prior_sigma = 10.0 / 3.0},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    P[P_y] = in.c[centre_y_error];
    P[P_z] = in.c[centre_z_error];
  }

  static std::vector<Example> examples() {
    return {{.coefficients = {6.0, -4.0}, .ports = {6.0, -4.0}, .source = "the shift itself"},
            {.coefficients = {-1.5, 2.5}, .t = 9.0, .ports = {-1.5, 2.5}, .source = "at any time"}};
  }
};

}  // namespace

MISFIT_EFFECT(image_centre, ImageCentre)
