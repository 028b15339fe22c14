#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A lens that bends straight lines beyond what the calibration says: radial distortion of third order.
struct LensDistortion {
  static constexpr const char* formula = "P = P0 + k1_error r^2 (P0 - c), r = |P0 - c|/(l_b K)";
  static constexpr const char* symbols =
      "P0 pixels by the calibrated camera, c its centre [px], l_b K focal length [px], k1_error [-]: negative is a barrel";
  static constexpr const char* valid = "to first order in k1: |k1| r^2 << 1 (r is 0.2 at 150 px)";
  static constexpr const char* size = "k1 = -0.1: 0.6 px at 150 px, 5 px at 300 px";
  static constexpr const char* source = "Brown, Close-range camera calibration, Photogrammetric Engineering 37 (1971)";
  static constexpr const char* excludes = "higher orders, tangential distortion";

  enum Quantity { P_y, P_z, focal_length };
  static constexpr Role quantities[] = {
      {.name = "P_y", .unit = "px"}, {.name = "P_z", .unit = "px"}, {.name = "focal_length", .unit = "px", .positive = true}};
  enum Port { P_y_port, P_z_port };
  static constexpr Role ports[] = {{.name = "P_y", .unit = "px"}, {.name = "P_z", .unit = "px"}};
  enum Constant { centre_y, centre_z };
  static constexpr const char* constants[] = {"centre_y", "centre_z"};
  enum Coefficient { k1_error };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "k1_error",
       .unit = "-",
       .lower = -10.0,
       .upper = 10.0,
       .scale = 0.1,
       .doc = "what is to be added to lens_k1",
       .calibrated_as = "lens_k1"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    const T y = in.q[P_y] - in.k[centre_y], z = in.q[P_z] - in.k[centre_z];
    const T stretch = in.c[k1_error] * (y * y + z * z) / (in.q[focal_length] * in.q[focal_length]);
    P[P_y_port] = stretch * y;
    P[P_z_port] = stretch * z;
  }

  static std::vector<Example> examples() {
    return {{.constants = {6.0, -4.0},
             .quantities = {36.0, 36.0, 100.0},
             .coefficients = {-0.2},
             .ports = {-1.5, -2.0},
             .source = "by hand: (30, 40) at 0.5 focal lengths: -0.05"},
            {.constants = {0.0, 0.0},
             .quantities = {0.0, 150.0, 761.6634},
             .coefficients = {0.1},
             .ports = {0.0, 0.581765018},
             .source = "150^3 x 0.1/761.6634^2"}};
  }
};

}  // namespace

MISFIT_EFFECT(lens_distortion, LensDistortion)
