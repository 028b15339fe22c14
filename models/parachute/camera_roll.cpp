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

  enum Quantity { P_y, P_z };
  static constexpr Role quantities[] = {{.name = "P_y", .unit = "px"}, {.name = "P_z", .unit = "px"}};
  enum Port { P_y_port, P_z_port };
  static constexpr Role ports[] = {{.name = "P_y", .unit = "px"}, {.name = "P_z", .unit = "px"}};
  enum Constant { centre_y, centre_z };
  static constexpr const char* constants[] = {"centre_y", "centre_z"};
  enum Coefficient { roll_error };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "roll_error",
       .unit = "rad",
       .lower = -3.2,
       .upper = 3.2,
       .scale = 0.02,
       .doc = "roll of the camera beyond its calibration",
       .calibrated_as = "camera_roll"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    using std::cos;
    using std::sin;
    const T y = in.q[P_y] - in.k[centre_y], z = in.q[P_z] - in.k[centre_z];
    const T sine = sin(in.c[roll_error]), half = sin(T(0.5 * in.c[roll_error]));
    const T less = 2.0 * half * half;  // 1 - cos
    P[P_y_port] = -less * y - sine * z;
    P[P_z_port] = sine * y - less * z;
  }

  static std::vector<Example> examples() {
    return {{.constants = {10.0, -20.0},
             .quantities = {110.0, 180.0},
             .coefficients = {0.52359878},
             .ports = {-113.397460, 23.2050808},
             .source = "100 (0.8660254 - 1) - 200/2; 100/2 - 200 x 0.1339746"},
            {.constants = {0.0, 0.0},
             .quantities = {0.0, 150.0},
             .coefficients = {0.017453293},
             .ports = {-2.61786095, -0.0228457259},
             .source = "1 deg: -150 sin, -150 (1 - cos)"}};
  }
};

}  // namespace

MISFIT_EFFECT(camera_roll, CameraRoll)
