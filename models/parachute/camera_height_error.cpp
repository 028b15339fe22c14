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
  static constexpr const char* source =
      "Schoenenberger, Queen, Cruz, Parachute Aerodynamics from Video Data, AIAA 2005-1633 (2005), Eqs. 1 and 7; Table 2: h_c +-0.0254 m, "
      "read as 3 sigma";
  static constexpr const char* excludes = "a camera that looks up or down (image_centre), which it resembles";

  enum Quantity { image_scale };
  static constexpr Role quantities[] = {{.name = "image_scale", .unit = "px/m"}};
  enum Port { P_y, P_z };
  static constexpr Role ports[] = {{.name = "P_y", .unit = "px"}, {.name = "P_z", .unit = "px"}};
  enum Constant { camera_roll };
  static constexpr const char* constants[] = {"camera_roll"};
  enum Coefficient { h_c_error };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "h_c_error",
       .unit = "m",
       .lower = -100.0,
       .upper = 100.0,
       .scale = 0.01,
       .doc = "what is to be added to h_c",
       .calibrated_as = "h_c",
       .prior_sigma = 0.0254 / 3.0},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    using std::cos;
    using std::sin;
    const T shift = in.c[h_c_error] * in.q[image_scale];
    P[P_y] = -shift * sin(in.k[camera_roll]);
    P[P_z] = shift * cos(in.k[camera_roll]);
  }

  static std::vector<Example> examples() {
    return {{.constants = {0.52359878},
             .quantities = {350.0},
             .coefficients = {0.02},
             .ports = {-3.5, 6.06217783},
             .source = "7 px, turned by 30 deg"},
            {.constants = {0.052359878},
             .quantities = {300.0},
             .coefficients = {-0.1},
             .ports = {1.57007869, -29.9588860},
             .source = "30 px, turned by 3 deg"}};
  }
};

}  // namespace

MISFIT_EFFECT(camera_height_error, CameraHeightError)
