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
  static constexpr Role ports[] = {{"wind_y", "m/s"}, {"wind_z", "m/s"}};
  static constexpr const char* constants[] = {"V"};
  static constexpr CoefficientSpec coefficients[] = {
      {"flow_theta", CoefficientKind::strength, 0.0, "rad", -0.5, 0.5, 0.01, "angle of the wind downwards"},
      {"flow_psi", CoefficientKind::strength, 0.0, "rad", -0.5, 0.5, 0.01, "angle of the wind to the left, looking upstream"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    using std::tan;
    P[0] = in.k[0] * tan(in.c[1]);
    P[1] = in.k[0] * tan(in.c[0]);
  }

  static std::vector<Example> examples() {
    return {{{35.1}, {}, {0.031415927, -0.019198622}, {}, 0.0, {-0.67395436, 1.1030622}, {}, "35.1 tan(1.1 deg), 35.1 tan(1.8 deg)"},
            {{10.0}, {}, {-0.46364761, 0.24497866}, {}, 0.0, {2.5, -5.0}, {}, "by hand: tangents 1/2 and 1/4"}};
  }
};

}  // namespace

MISFIT_EFFECT(flow_angularity, FlowAngularity)
