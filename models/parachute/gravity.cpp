#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Weight of the parachute (not of the apparent mass: it is carried by buoyancy) at the centre of pressure.
struct Gravity {
  static constexpr const char* formula = "M = m g R_cp cos(phi) cos(eta)";
  static constexpr const char* symbols = "m mass of the parachute [kg], R_cp [m], phi clock angle, eta tilt [rad], g = 9.80665 m/s^2";
  static constexpr const char* valid = "always; the centre of mass is taken at R_cp, as the source does";
  static constexpr const char* size = "6.4 N m for m = 0.206 kg, R_cp = 3.15 m: a fifth of the random moment";
  static constexpr const char* source =
      "Schoenenberger, Queen, Cruz, Parachute Aerodynamics from Video Data, AIAA 2005-1633 (2005), Eq. 8, last term; g: CGPM 1901";
  static constexpr const char* excludes = "weight of lines and swivel";

  enum Quantity { gravity_direction, gravity_direction_lateral };
  static constexpr Role quantities[] = {{.name = "gravity_direction", .unit = "-"},
                                        {.name = "gravity_direction_lateral", .unit = "-", .optional = true}};
  enum Port { pitching_moment, lateral_moment };
  static constexpr Role ports[] = {{.name = "pitching_moment", .unit = "N m"}, {.name = "lateral_moment", .unit = "N m", .optional = true}};
  enum Constant { m, R_cp };
  static constexpr const char* constants[] = {"m", "R_cp"};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    constexpr double standard_gravity = 9.80665;
    F[pitching_moment] = in.k[m] * standard_gravity * in.k[R_cp] * in.q[gravity_direction];
    F[lateral_moment] = in.k[m] * standard_gravity * in.k[R_cp] * in.q[gravity_direction_lateral];
  }

  static std::vector<Example> examples() {
    return {
        {.constants = {0.206, 3.15}, .quantities = {1.0, 0.0}, .ports = {6.3635352, 0.0}, .source = "0.206 x 9.80665 x 3.15 = 6.36354 N m"},
        {.constants = {2.0, 1.0}, .quantities = {0.5, -0.25}, .ports = {9.80665, -4.903325}, .source = "by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(gravity, Gravity)
