#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The scale K of the camera is not the calibrated one: pixels grow about the image centre.
struct ScaleError {
  static constexpr const char* formula = "P = c + (1 + K_error/K)(P0 - c), c = (centre_y, centre_z)";
  static constexpr const char* symbols = "P0 pixels by the calibrated camera, c its centre [px], K [px/m], K_error [px/m]";
  static constexpr const char* valid = "a lens without distortion (the distortion would grow with the cube)";
  static constexpr const char* size = "1.97 px/m (Table 2) of 134 px/m: 1.5 %, 0.2 deg at 12 deg of tilt";
  static constexpr const char* source =
      "Schoenenberger, Queen, Cruz, Parachute Aerodynamics from Video Data, AIAA 2005-1633 (2005), Table 2: K +-1.969 px/m, read as 3 "
      "sigma";
  static constexpr const char* excludes = "a wrong distance between rig and camera: a scale that depends on the tilt";

  enum Quantity { P_y, P_z };
  static constexpr Role quantities[] = {{.name = "P_y", .unit = "px"}, {.name = "P_z", .unit = "px"}};
  enum Port { P_y_port, P_z_port };
  static constexpr Role ports[] = {{.name = "P_y", .unit = "px"}, {.name = "P_z", .unit = "px"}};
  enum Constant { K_constant, centre_y, centre_z };  // K alone is the type of the constants below
  static constexpr const char* constants[] = {"K", "centre_y", "centre_z"};
  enum Coefficient { K_error };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "K_error",
       .unit = "px/m",
       .lower = -1e4,
       .upper = 1e4,
       .scale = 1.0,
       .doc = "what is to be added to K",
       .calibrated_as = "K",
       .prior_sigma = 1.969 / 3.0},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    const T more = in.c[K_error] / in.k[K_constant];
    P[P_y_port] = more * (in.q[P_y] - in.k[centre_y]);
    P[P_z_port] = more * (in.q[P_z] - in.k[centre_z]);
  }

  static std::vector<Example> examples() {
    return {{.constants = {133.86, 6.0, -4.0},
             .quantities = {106.0, 146.0},
             .coefficients = {1.969},
             .ports = {1.47094, 2.20640968},
             .source = "1.969/133.86 = 0.0147094 of (100, 150)"},
            {.constants = {100.0, 0.0, 0.0},
             .quantities = {50.0, -20.0},
             .coefficients = {-10.0},
             .ports = {-5.0, 2.0},
             .source = "by hand: a tenth less"}};
  }
};

}  // namespace

MISFIT_EFFECT(scale_error, ScaleError)
