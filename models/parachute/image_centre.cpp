#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The image centre is not where the calibration puts it: all pixels are shifted.
struct ImageCentre {
  static constexpr const char* formula = "P_y = P_y0 + centre_y_error, P_z = P_z0 + centre_z_error";
  static constexpr const char* symbols = "P_y0, P_z0 pixels by the calibrated camera; errors of its centre [px]";
  static constexpr const char* valid = "a camera that does not move during the recording";
  static constexpr const char* size = "10 px (Table 2): 1.6 deg of tilt with K = 134 px/m";
  static constexpr const char* source = "paper Table 2: P_y, P_z +-10 px, read as 3 sigma";
  static constexpr const char* excludes =
      "a camera that shakes or drifts; wind that is not along the tunnel axis looks the same (flow_angularity)";
  static constexpr const char* specialises = "bias";  // which would shift P_z without the prior that the calibration gives
  static constexpr Role ports[] = {{"P_y", "px"}, {"P_z", "px"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"centre_y_error", CoefficientKind::strength, 0.0, "px", -1e4, 1e4, 3.0, "shift of P_y beyond the calibration", Parity::none, "",
       false, false, ScanSpec{}, "centre_y", 10.0 / 3.0},
      {"centre_z_error", CoefficientKind::strength, 0.0, "px", -1e4, 1e4, 3.0, "shift of P_z beyond the calibration", Parity::none, "",
       false, false, ScanSpec{}, "centre_z", 10.0 / 3.0}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    P[0] = in.c[0];
    P[1] = in.c[1];
  }

  static std::vector<Example> examples() {
    return {{{}, {}, {6.0, -4.0}, {}, 0.0, {6.0, -4.0}, {}, "the shift itself"},
            {{}, {}, {-1.5, 2.5}, {}, 9.0, {-1.5, 2.5}, {}, "at any time"}};
  }
};

}  // namespace

MISFIT_EFFECT(image_centre, ImageCentre)
