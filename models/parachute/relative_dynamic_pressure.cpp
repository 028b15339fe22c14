#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The static moment goes with the dynamic pressure of the wind that the canopy feels, V x^ - R_cp n', instead of that of the free stream.
struct RelativeDynamicPressure {
  static constexpr const char* formula =
      "M = relative_pressure (v^2/V^2 - 1) x static moment, v^2/V^2 - 1 = 2 r sin(eta) omega_in-plane + r^2 |omega|^2, r = R_cp/V";
  static constexpr const char* symbols = "v felt wind, V wind speed [m/s], omega rotation rates [rad/s], C_m of the static moment [-]";
  static constexpr const char* valid = "quasi-steady; planar systems miss the lateral part of |omega|";
  static constexpr const char* size = "omega = 1 rad/s at eta = 12 deg: 4.5 % of the static moment";
  static constexpr const char* source =
      "Etkin and Reid, Dynamics of Flight (1996): coefficients refer to the relative wind; 1 is the full correction";
  static constexpr const char* excludes = "side wind in v (flow_angularity), the pressure in the damping";
  static constexpr Role quantities[] = {{"dynamic_pressure", "Pa"},
                                        {"wind_speed", "m/s", false, true},
                                        {"wind_cross_axis", "-"},
                                        {"wind_cross_axis_lateral", "-", true},
                                        {"eta", "rad"},
                                        {"pitch_rate", "rad/s"},
                                        {"lateral_rate", "rad/s", true}};
  static constexpr Role ports[] = {{"pitching_moment", "N m"}, {"lateral_moment", "N m", true}};
  static constexpr const char* constants[] = {"S", "D", "R_cp"};
  static constexpr CoefficientSpec coefficients[] = {
      {"relative_pressure", CoefficientKind::strength, 0.0, "-", -10.0, 10.0, 1.0, "0: free stream; 1: felt wind"},
      borrowed_coefficient("C_m", "-", "static moment coefficient over the sine of alpha_T")};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::sin;
    const T lever = in.k[2] / in.q[1];
    const T more = lever * (2.0 * sin(in.q[4]) * in.q[5] + lever * (in.q[5] * in.q[5] + in.q[6] * in.q[6]));
    const T moment = in.q[0] * (in.k[0] * in.k[1]) * in.c[1] * in.c[0] * more;
    F[0] = moment * in.q[2];
    F[1] = moment * in.q[3];
  }

  static std::vector<Example> examples() {
    // r = 3/30 = 0.1: 0.1 (2 x 0.5 x 2 + 0.1 x (4 + 9)) = 0.33; 100 x 2 x 1.5 x 0.5 x 0.33 = 49.5
    return {{{2.0, 1.5, 3.0}, {100.0, 30.0, 0.3, -0.1, 0.52359878, 2.0, 3.0}, {1.0, 0.5}, {}, 0.0, {14.85, -4.95}, {}, "by hand: 49.5"},
            {{2.0, 1.5, 3.0},
             {100.0, 30.0, 0.2, 0.0, 0.52359878, -1.0, 0.0},
             {0.5, -0.4},
             {},
             0.0,
             {1.08, 0.0},
             {},
             "by hand: -60 x -0.09 x 0.2"}};
  }
};

}  // namespace

MISFIT_EFFECT(relative_dynamic_pressure, RelativeDynamicPressure)
