#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Aerodynamic moment proportional to the rate of rotation. Which derivative the coefficient is depends on the system's alpha_T. Where
/// alpha_T is the angle of the relative wind, which turns with the rotation, it is the pitch damping derivative C_mq. Where alpha_T is the
/// tilt itself (induced_angle = false: Eq. 8 of the source), it also has to stand for that turning of the wind and is the derivative
/// C_m_alphadot = C_mq + (2 R_cp/D) dC_m/dalpha_T cos(alpha_T), lib/misfit/README.md (11).
struct PitchDamping {
  static constexpr const char* formula = "M = q S D (D/2V) C_mq(alpha_T) omega";
  static constexpr const char* symbols = "q [Pa], S [m^2], D [m], V wind speed [m/s], omega rotation rate of the axis [rad/s], C_mq [-]";
  static constexpr const char* valid = "quasi-steady flow: reduced frequency pi f D/V << 1, f the frequency of the motion [Hz]";
  static constexpr const char* size = "C_mq = -0.25 at 1 rad/s: -12.8 N m at 736 Pa, 35.1 m/s, D = 1.58 m";
  static constexpr const char* source =
      "Schoenenberger, Queen, Cruz, Parachute Aerodynamics from Video Data, AIAA 2005-1633 (2005), Eq. 8; lib/misfit/README.md (10), (13)";
  static constexpr const char* excludes = "memory of the wake (aerodynamic lag)";

  enum Quantity { dynamic_pressure, wind_speed, pitch_rate, lateral_rate };
  static constexpr Role quantities[] = {{.name = "dynamic_pressure", .unit = "Pa"},
                                        {.name = "wind_speed", .unit = "m/s", .positive = true},
                                        {.name = "pitch_rate", .unit = "rad/s"},
                                        {.name = "lateral_rate", .unit = "rad/s", .optional = true}};
  enum Port { pitching_moment, lateral_moment };
  static constexpr Role ports[] = {{.name = "pitching_moment", .unit = "N m"}, {.name = "lateral_moment", .unit = "N m", .optional = true}};
  enum Constant { S, D };
  static constexpr const char* constants[] = {"S", "D"};
  enum Coefficient { C_mq };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "C_mq",
       .unit = "-",
       .lower = -50.0,
       .upper = 50.0,
       .scale = 0.25,
       .doc = "pitch damping coefficient; negative takes energy out",
       .parity = Parity::even,
       .curve_of = "alpha_T"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T moment = in.q[dynamic_pressure] * (in.k[S] * in.k[D] * in.k[D]) / (2.0 * in.q[wind_speed]) * in.c[C_mq];
    F[pitching_moment] = moment * in.q[pitch_rate];
    F[lateral_moment] = moment * in.q[lateral_rate];
  }

  static std::vector<Example> examples() {
    return {{.constants = {1.9554, 1.5816},
             .quantities = {736.0, 35.1, 1.0, 0.0},
             .coefficients = {-0.25},
             .ports = {-12.820638, 0.0},
             .source = "2276.1982 x 1.5816/70.2 x -0.25"},
            {.constants = {2.0, 3.0},
             .quantities = {100.0, 30.0, 0.5, -2.0},
             .coefficients = {0.4},
             .ports = {6.0, -24.0},
             .source = "by hand: 100 x 2 x 9/60 x 0.4 = 12; x 0.5, x -2"}};
  }
};

}  // namespace

MISFIT_EFFECT(pitch_damping, PitchDamping)
