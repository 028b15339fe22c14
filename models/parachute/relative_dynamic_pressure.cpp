#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The static moment goes with the dynamic pressure of the wind that the canopy feels, V x^ - R_cp n', instead of that of the free stream.
struct RelativeDynamicPressure {
  static constexpr const char* formula =
      "M = relative_pressure (v^2/V^2 - 1) x static moment, v^2/V^2 - 1 = 2 r sin(eta) omega_in-plane + r^2 |omega|^2, r = R_cp/V";
  static constexpr const char* symbols = "v relative wind, V wind speed [m/s], omega rotation rates [rad/s], C_m of the static moment [-]";
  static constexpr const char* valid = "quasi-steady; planar systems miss the lateral part of |omega|";
  static constexpr const char* size = "omega = 1 rad/s at eta = 12 deg: 4.5 % of the static moment";
  static constexpr const char* source =
      "Etkin and Reid, Dynamics of Flight (1996): coefficients refer to the relative wind; 1 is the full correction";
  static constexpr const char* excludes = "side wind in v (flow_angularity), the pressure in the damping";

  enum Quantity { dynamic_pressure, wind_speed, wind_cross_axis, wind_cross_axis_lateral, eta, pitch_rate, lateral_rate };
  static constexpr Role quantities[] = {{.name = "dynamic_pressure", .unit = "Pa"},
                                        {.name = "wind_speed", .unit = "m/s", .positive = true},
                                        {.name = "wind_cross_axis", .unit = "-"},
                                        {.name = "wind_cross_axis_lateral", .unit = "-", .optional = true},
                                        {.name = "eta", .unit = "rad"},
                                        {.name = "pitch_rate", .unit = "rad/s"},
                                        {.name = "lateral_rate", .unit = "rad/s", .optional = true}};
  enum Port { pitching_moment, lateral_moment };
  static constexpr Role ports[] = {{.name = "pitching_moment", .unit = "N m"}, {.name = "lateral_moment", .unit = "N m", .optional = true}};
  enum Constant { S, D, R_cp };
  static constexpr const char* constants[] = {"S", "D", "R_cp"};
  enum Coefficient { relative_pressure, C_m };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "relative_pressure", .unit = "-", .lower = -10.0, .upper = 10.0, .scale = 1.0, .doc = "0: free stream; 1: relative wind"},
      {.name = "C_m",
       .kind = CoefficientKind::shape,
       .unit = "-",
       .lower = -1e6,
       .upper = 1e6,
       .doc = "static moment coefficient over the sine of alpha_T",
       .shared = true},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::sin;
    const T lever = in.k[R_cp] / in.q[wind_speed];
    const T more = lever * (2.0 * sin(in.q[eta]) * in.q[pitch_rate] +
                            lever * (in.q[pitch_rate] * in.q[pitch_rate] + in.q[lateral_rate] * in.q[lateral_rate]));
    const T moment = in.q[dynamic_pressure] * (in.k[S] * in.k[D]) * in.c[C_m] * in.c[relative_pressure] * more;
    F[pitching_moment] = moment * in.q[wind_cross_axis];
    F[lateral_moment] = moment * in.q[wind_cross_axis_lateral];
  }

  static std::vector<Example> examples() {
    // r = 3/30 = 0.1: 0.1 (2 x 0.5 x 2 + 0.1 x (4 + 9)) = 0.33; 100 x 2 x 1.5 x 0.5 x 0.33 = 49.5
    return {{.constants = {2.0, 1.5, 3.0},
             .quantities = {100.0, 30.0, 0.3, -0.1, 0.52359878, 2.0, 3.0},
             .coefficients = {1.0, 0.5},
             .ports = {14.85, -4.95},
             .source = "by hand: 49.5"},
            {.constants = {2.0, 1.5, 3.0},
             .quantities = {100.0, 30.0, 0.2, 0.0, 0.52359878, -1.0, 0.0},
             .coefficients = {0.5, -0.4},
             .ports = {1.08, 0.0},
             .source = "by hand: -60 x -0.09 x 0.2"}};
  }
};

}  // namespace

MISFIT_EFFECT(relative_dynamic_pressure, RelativeDynamicPressure)
