#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The camera is rolled about its optical axis by more than its calibration says.
struct CameraRoll {
  static constexpr const char* formula =
      "P = c + [cos e, -sin e; sin e, cos e] (P0 - c) on (P_y; P_z), c = (centre_y, centre_z), e = roll_error";
  static constexpr const char* symbols = "P0 pixels by the calibrated camera, c its centre [px], e [rad]: positive turns +z (down) to -y";
  static constexpr const char* valid = "square pixels (pixel_aspect about 0: both orders of roll and aspect agree)";
  static constexpr const char* size = "1 deg at 150 px from the centre: 2.6 px across";
  static constexpr const char* source = "rotation of the image plane; order as in math/camera.h";
  static constexpr const char* excludes = "tilt of the optical axis: to first order a shift (image_centre)";
  static constexpr Role quantities[] = {{"P_y", "px"}, {"P_z", "px"}};
  static constexpr Role ports[] = {{"P_y", "px"}, {"P_z", "px"}};
  static constexpr const char* constants[] = {"centre_y", "centre_z"};
  static constexpr CoefficientSpec coefficients[] = {{"roll_error", CoefficientKind::strength, 0.0, "rad", -3.2, 3.2, 0.02,
                                                      "roll of the camera beyond its calibration", Parity::none, "", false, false,
                                                      ScanSpec{}, "camera_roll"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    using std::cos;
    using std::sin;
    const T y = in.q[0] - in.k[0], z = in.q[1] - in.k[1];
    const T sine = sin(in.c[0]), half = sin(T(0.5 * in.c[0]));
    const T less = 2.0 * half * half;  // 1 - cos
    P[0] = -less * y - sine * z;
    P[1] = sine * y - less * z;
  }

  static std::vector<Example> examples() {
    return {{{10.0, -20.0},
             {110.0, 180.0},
             {0.52359878},
             {},
             0.0,
             {-113.397460, 23.2050808},
             {},
             "100 (0.8660254 - 1) - 200/2; 100/2 - 200 x 0.1339746"},
            {{0.0, 0.0}, {0.0, 150.0}, {0.017453293}, {}, 0.0, {-2.61786095, -0.0228457259}, {}, "1 deg: -150 sin, -150 (1 - cos)"}};
  }
};

}  // namespace

MISFIT_EFFECT(camera_roll, CameraRoll)
