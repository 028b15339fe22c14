#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Damping across the plane of axis and relative wind that differs from the damping in it: what `pitch_damping` applies to both is changed
/// for one. The moment of an axisymmetric canopy knows no other plane: that of the geometric tilt is the same only while R_cp n' is small
/// against V.
struct LateralDamping {
  static constexpr const char* formula =
      "(M_pitch, M_lateral) = q S D (D/2V) C_lateral omega_a (-w_lateral, w) sin^2(alpha_T)/(sin^4(alpha_T) + 0.02^4), omega_a = w "
      "omega_lateral - w_lateral omega";
  static constexpr const char* symbols =
      "q [Pa], S [m^2], D [m], V wind speed [m/s], w, w_lateral components of (wind direction x axis), root of their squares "
      "sin(alpha_T) [-], omega, omega_lateral rotation rates in and across the plane of the tilt [rad/s], omega_a/sin(alpha_T) that across "
      "the plane of axis and relative wind, C_lateral [-]";
  static constexpr const char* valid =
      "quasi-steady; adds to C_mq of pitch_damping; at angles of attack near 0 the two planes cannot differ";
  static constexpr const char* size = "-0.25 at 1 rad/s: -12.8 N m at 736 Pa, 35.1 m/s, D = 1.58 m";
  static constexpr const char* source =
      "Tobak and Schiff, NASA TR R-456 (1976): damping in coning motion about the direction of flight is a characteristic of its own";
  static constexpr const char* excludes = "memory of the wake (aerodynamic_lag)";

  enum Quantity { dynamic_pressure, wind_speed, pitch_rate, lateral_rate, wind_cross_axis, wind_cross_axis_lateral };
  static constexpr Role quantities[] = {{.name = "dynamic_pressure", .unit = "Pa"}, {.name = "wind_speed", .unit = "m/s", .positive = true},
                                        {.name = "pitch_rate", .unit = "rad/s"},    {.name = "lateral_rate", .unit = "rad/s"},
                                        {.name = "wind_cross_axis", .unit = "-"},   {.name = "wind_cross_axis_lateral", .unit = "-"}};
  enum Port { pitching_moment, lateral_moment };
  static constexpr Role ports[] = {{.name = "pitching_moment", .unit = "N m"}, {.name = "lateral_moment", .unit = "N m"}};
  enum Constant { S, D };
  static constexpr const char* constants[] = {"S", "D"};
  enum Coefficient { C_lateral };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "C_lateral",
       .unit = "-",
       .lower = -50.0,
       .upper = 50.0,
       .scale = 0.25,
       .doc = "lateral damping coefficient besides C_mq; negative takes energy out"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    constexpr double covered = 0.02;  // sine of the angle of attack below which its plane means nothing
    const T w = in.q[wind_cross_axis], across = in.q[wind_cross_axis_lateral];
    const T squared = w * w + across * across;
    const T open = squared / (squared * squared + covered * covered * covered * covered);
    const T rate = w * in.q[lateral_rate] - across * in.q[pitch_rate];
    const T moment = in.q[dynamic_pressure] * (in.k[S] * in.k[D] * in.k[D]) / (2.0 * in.q[wind_speed]) * in.c[C_lateral] * rate * open;
    F[pitching_moment] = -moment * across;
    F[lateral_moment] = moment * w;
  }

  static std::vector<Example> examples() {
    return {{.constants = {1.9554, 1.5816},
             .quantities = {736.0, 35.1, 0.0, 1.0, 1.0, 0.0},
             .coefficients = {-0.25},
             .ports = {0.0, -12.8206356},
             .source = "wind in the plane of the tilt, across the axis: 12.8206377/(1 + 0.02^4)"},
            {.constants = {2.0, 3.0},
             .quantities = {100.0, 30.0, 0.5, -2.0, 0.012, 0.016},
             .coefficients = {0.4},
             .ports = {7.68, -5.76},
             .source = "100 x 2 x 9/60 x 0.4 = 12; omega_a = 0.012 x -2 - 0.016 x 0.5 = -0.032; half open at 0.02: 0.02^2/(2 x 0.02^4) = "
                       "1250; 12 x -0.032 x 1250 = -480; x -0.016, x 0.012"}};
  }
};

}  // namespace

MISFIT_EFFECT(lateral_damping, LateralDamping)
