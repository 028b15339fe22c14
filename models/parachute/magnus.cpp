#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A canopy that spins steadily moves across the air: Magnus force n x n', at right angles to the motion, and of the same form the
/// gyroscopic moment of its spin. It does no work. The part with the wind V instead of n' is a side moment (side_moment).
struct Magnus {
  static constexpr const char* formula = "M_in-plane = -q S D (D/2V) C_spin omega_lateral, M_lateral = q S D (D/2V) C_spin omega_in-plane";
  static constexpr const char* symbols =
      "q [Pa], S [m^2], D [m], V wind speed [m/s], omega rotation rates [rad/s], C_spin [-] proportional to the spin";
  static constexpr const char* valid = "spin that is steady over the recording";
  static constexpr const char* size = "0.05 at 1 rad/s: 2.6 N m at 736 Pa, 35.1 m/s, D = 1.58 m; the plane of the swing turns slowly";
  static constexpr const char* source = "Magnus force of a spinning body; gyroscope: Goldstein, Classical Mechanics, chapter 5";
  static constexpr const char* excludes = "spin that changes, the swivel's own inertia";

  enum Quantity { dynamic_pressure, wind_speed, pitch_rate, lateral_rate };
  static constexpr Role quantities[] = {{.name = "dynamic_pressure", .unit = "Pa"},
                                        {.name = "wind_speed", .unit = "m/s", .positive = true},
                                        {.name = "pitch_rate", .unit = "rad/s"},
                                        {.name = "lateral_rate", .unit = "rad/s"}};
  enum Port { pitching_moment, lateral_moment };
  static constexpr Role ports[] = {{.name = "pitching_moment", .unit = "N m"}, {.name = "lateral_moment", .unit = "N m"}};
  enum Constant { S, D };
  static constexpr const char* constants[] = {"S", "D"};
  enum Coefficient { C_spin };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "C_spin", .unit = "-", .lower = -50.0, .upper = 50.0, .scale = 0.05, .doc = "coefficient of the moment across the motion"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T moment = in.q[dynamic_pressure] * (in.k[S] * in.k[D] * in.k[D]) / (2.0 * in.q[wind_speed]) * in.c[C_spin];
    F[pitching_moment] = -moment * in.q[lateral_rate];
    F[lateral_moment] = moment * in.q[pitch_rate];
  }

  static std::vector<Example> examples() {
    return {{.constants = {1.9554, 1.5816},
             .quantities = {736.0, 35.1, 1.0, 0.0},
             .coefficients = {0.05},
             .ports = {0.0, 2.56412764},
             .source = "2276.1982 x 1.5816/70.2 x 0.05"},
            {.constants = {2.0, 3.0},
             .quantities = {100.0, 30.0, 0.5, -2.0},
             .coefficients = {0.4},
             .ports = {24.0, 6.0},
             .source = "by hand: 12 x 2, 12 x 0.5"}};
  }
};

}  // namespace

MISFIT_EFFECT(magnus, Magnus)
