#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The moment of the canopy at a constant total angle of attack, along (v̂ × n): regular where alpha_T = 0 because an odd C_m is divided by
/// sin(alpha_T) and |v̂ × n| = sin(alpha_T).
struct StaticMoment {
  static constexpr const char* formula = "M = q S D [C_m(alpha_T)/sin(alpha_T)] (v x n)";
  static constexpr const char* symbols =
      "q dynamic pressure [Pa], S area [m^2], D diameter [m], v x n component of (wind direction x axis) [-]";
  static constexpr const char* valid = "axisymmetric canopy, quasi-steady, |alpha_T| < 90 deg";
  static constexpr const char* size = "C_m about +-0.02 within 3 deg of the trim: 45 N m at 736 Pa for D = 1.58 m";
  static constexpr const char* source =
      "Schoenenberger, Queen, Cruz, Parachute Aerodynamics from Video Data, AIAA 2005-1633 (2005), Eq. 9; lib/misfit/README.md (10), (13)";
  static constexpr const char* specialises = "constant_force";  // which would shift C_m without the roughness that the curve has
  static constexpr const char* excludes = "side moment, hysteresis, wake of the strut";

  enum Quantity { dynamic_pressure, wind_cross_axis, wind_cross_axis_lateral };
  static constexpr Role quantities[] = {{.name = "dynamic_pressure", .unit = "Pa"},
                                        {.name = "wind_cross_axis", .unit = "-"},
                                        {.name = "wind_cross_axis_lateral", .unit = "-", .optional = true}};
  enum Port { pitching_moment, lateral_moment };
  static constexpr Role ports[] = {{.name = "pitching_moment", .unit = "N m"}, {.name = "lateral_moment", .unit = "N m", .optional = true}};
  enum Constant { S, D };
  static constexpr const char* constants[] = {"S", "D"};
  enum Coefficient { C_m };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "C_m",
       .unit = "-",
       .lower = -10.0,
       .upper = 10.0,
       .scale = 0.02,
       .doc = "static pitching moment coefficient about the swivel",
       .parity = Parity::odd,
       .curve_of = "alpha_T",
       .over_sine = true},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T moment = in.q[dynamic_pressure] * (in.k[S] * in.k[D]) * in.c[C_m];
    F[pitching_moment] = moment * in.q[wind_cross_axis];
    F[lateral_moment] = moment * in.q[wind_cross_axis_lateral];
  }

  static std::vector<Example> examples() {
    // 736 Pa x 1.9554 m^2 x 1.5816 m = 2276.1982 N m per unit coefficient; at alpha_T = 10 deg: C_m = 0.0105, sin = 0.17364818, so C_m/sin
    // = 0.060467094 and in the plane of motion (v x n) = sin(10 deg): moment = 2276.1982 x 0.0105 = 23.900081 N m.
    return {{.constants = {1.9554, 1.5816},
             .quantities = {736.0, 0.17364818, 0.0},
             .coefficients = {0.0105 / 0.17364818},
             .ports = {23.900081, 0.0},
             .source = "Schoenenberger, Queen, Cruz, Parachute Aerodynamics from Video Data, AIAA 2005-1633 (2005), Eq. 9, Table 1"},
            {.constants = {2.0, 1.5},
             .quantities = {100.0, 0.3, -0.1},
             .coefficients = {0.5},
             .ports = {45.0, -15.0},
             .source = "by hand: 100 x 2 x 1.5 x 0.5 = 150; x 0.3, x -0.1"}};
  }
};

}  // namespace

MISFIT_EFFECT(static_moment, StaticMoment)
