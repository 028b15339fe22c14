#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The wind is not parallel to the tunnel axis: side components of the wind that the canopy feels. The axial component keeps its speed.
struct FlowAngularity {
  static constexpr const char* formula = "wind_z = V tan(flow_theta), wind_y = V tan(flow_psi)";
  static constexpr const char* symbols =
      "V free-stream speed [m/s]; direction of the wind as theta and psi of an axis: flow_theta towards +z (down; upwash is negative), "
      "flow_psi towards +y (left, looking upstream) [rad]";
  static constexpr const char* valid = "the same angles wherever the canopy goes, and at all times";
  static constexpr const char* size = "1 deg moves the centre of the motion by 1 deg; good tunnels hold 0.2 deg, behind a model more";
  static constexpr const char* source = "geometry; AGARD-AG-184 (1975) on flow angularity of wind tunnels";
  static constexpr const char* excludes =
      "swirl and gradients; a camera whose centre is off by l_b K R tan(angle)/(l_s - R) looks the same (image_centre)";

  enum Port { wind_y, wind_z };
  static constexpr Role ports[] = {{.name = "wind_y", .unit = "m/s"}, {.name = "wind_z", .unit = "m/s"}};
  enum Constant { V };
  static constexpr const char* constants[] = {"V"};
  enum Coefficient { flow_theta, flow_psi };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "flow_theta", .unit = "rad", .lower = -0.5, .upper = 0.5, .scale = 0.01, .doc = "angle of the wind downwards"},
      {.name = "flow_psi",
       .unit = "rad",
       .lower = -0.5,
       .upper = 0.5,
       .scale = 0.01,
       .doc = "angle of the wind to the left, looking upstream"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    using std::tan;
    P[wind_y] = in.k[V] * tan(in.c[flow_psi]);
    P[wind_z] = in.k[V] * tan(in.c[flow_theta]);
  }

  static std::vector<Example> examples() {
    return {
        {.constants = {35.1},
         .coefficients = {0.031415927, -0.019198622},
         .ports = {-0.67395436, 1.1030622},
         .source = "35.1 tan(1.1 deg), 35.1 tan(1.8 deg)"},
        {.constants = {10.0}, .coefficients = {-0.46364761, 0.24497866}, .ports = {2.5, -5.0}, .source = "by hand: tangents 1/2 and 1/4"}};
  }
};

}  // namespace

MISFIT_EFFECT(flow_angularity, FlowAngularity)
