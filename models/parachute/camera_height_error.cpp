#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The camera stands higher than measured: a shift of the image that grows as the apex comes nearer.
struct CameraHeightError {
  static constexpr const char* formula = "P = P0 + image_scale h_c_error (-sin(roll), cos(roll)) on (P_y, P_z)";
  static constexpr const char* symbols =
      "P0 pixels by the calibrated camera, image_scale pixels per metre at the apex [px/m], h_c_error [m], roll of the calibrated camera";
  static constexpr const char* valid = "pinhole camera, square pixels, no distortion";
  static constexpr const char* size = "1 in (Table 2): 9 px, of which less than 1 px varies with the tilt up to 20 deg";
  static constexpr const char* source = "paper Eqs. 1 and 7; Table 2: h_c +-0.0254 m, read as 3 sigma";
  static constexpr const char* excludes = "a camera that looks up or down (image_centre), which it resembles";
  static constexpr Role quantities[] = {{"image_scale", "px/m"}};
  static constexpr Role ports[] = {{"P_y", "px"}, {"P_z", "px"}};
  static constexpr const char* constants[] = {"camera_roll"};
  static constexpr CoefficientSpec coefficients[] = {{"h_c_error", CoefficientKind::strength, 0.0, "m", -100.0, 100.0, 0.01,
                                                      "what is to be added to h_c", Parity::none, "", false, false, ScanSpec{}, "h_c",
                                                      0.0254 / 3.0}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    using std::cos;
    using std::sin;
    const T shift = in.c[0] * in.q[0];
    P[0] = -shift * sin(in.k[0]);
    P[1] = shift * cos(in.k[0]);
  }

  static std::vector<Example> examples() {
    return {{{0.52359878}, {350.0}, {0.02}, {}, 0.0, {-3.5, 6.06217783}, {}, "7 px, turned by 30 deg"},
            {{0.052359878}, {300.0}, {-0.1}, {}, 0.0, {1.57007869, -29.9588860}, {}, "30 px, turned by 3 deg"}};
  }
};

}  // namespace

MISFIT_EFFECT(camera_height_error, CameraHeightError)
