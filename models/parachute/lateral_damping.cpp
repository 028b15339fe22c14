#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Damping across the plane of the tilt that differs from the damping in it: what `pitch_damping` applies to both is changed for one.
struct LateralDamping {
  static constexpr const char* formula = "M_lateral = q S D (D/2V) C_lateral omega_lateral sin^4(eta)/(sin^4(eta) + 0.02^4)";
  static constexpr const char* symbols =
      "q [Pa], S [m^2], D [m], V wind speed [m/s], omega_lateral rotation rate across the plane of the tilt [rad/s], C_lateral [-]";
  static constexpr const char* valid = "quasi-steady; adds to C_mq of pitch_damping; at tilts near 0 the two planes cannot differ";
  static constexpr const char* size = "-0.25 at 1 rad/s: -12.8 N m at 736 Pa, 35.1 m/s, D = 1.58 m";
  static constexpr const char* source = "Tobak and Schiff, NASA TR R-456 (1976): damping in coning motion is a characteristic of its own";
  static constexpr const char* excludes = "memory of the wake (aerodynamic_lag)";

  enum Quantity { dynamic_pressure, wind_speed, lateral_rate, eta };
  static constexpr Role quantities[] = {{.name = "dynamic_pressure", .unit = "Pa"},
                                        {.name = "wind_speed", .unit = "m/s", .positive = true},
                                        {.name = "lateral_rate", .unit = "rad/s"},
                                        {.name = "eta", .unit = "rad"}};
  enum Port { lateral_moment };
  static constexpr Role ports[] = {{.name = "lateral_moment", .unit = "N m"}};
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
    using std::sin;
    constexpr double covered = 0.02;  // sine of the tilt below which the plane of the tilt means nothing (strut_wake)
    const T sine = sin(in.q[eta]);
    const T fourth = sine * sine * sine * sine;
    const T open = fourth / (fourth + covered * covered * covered * covered);
    F[lateral_moment] =
        in.q[dynamic_pressure] * (in.k[S] * in.k[D] * in.k[D]) / (2.0 * in.q[wind_speed]) * in.c[C_lateral] * in.q[lateral_rate] * open;
  }

  static std::vector<Example> examples() {
    return {{.constants = {1.9554, 1.5816},
             .quantities = {736.0, 35.1, 1.0, 1.57079633},
             .coefficients = {-0.25},
             .ports = {-12.8206356},
             .source = "12.8206377/(1 + 0.02^4)"},
            {.constants = {2.0, 3.0},
             .quantities = {100.0, 30.0, -2.0, 0.020001334},
             .coefficients = {0.4},
             .ports = {-12.0},
             .source = "100 x 2 x 9/60 x 0.4 x -2, half open at sin = 0.02"}};
  }
};

}  // namespace

MISFIT_EFFECT(lateral_damping, LateralDamping)
