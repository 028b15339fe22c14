#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Weight of the parachute (not of the apparent mass: it is carried by buoyancy) at the centre of pressure.
struct Gravity {
  static constexpr const char* formula = "M = m g R_cp cos(phi) cos(eta)";
  static constexpr const char* symbols = "m mass of the parachute [kg], R_cp [m], phi clock angle, eta tilt [rad], g = 9.80665 m/s^2";
  static constexpr const char* valid = "always; the centre of mass is taken at R_cp as the paper does";
  static constexpr const char* size = "6.4 N m for m = 0.206 kg, R_cp = 3.15 m: a fifth of the random moment";
  static constexpr const char* source = "paper Eq. 8, last term; g: CGPM 1901";
  static constexpr const char* excludes = "weight of lines and swivel";
  static constexpr Role quantities[] = {{"gravity_direction", "-"}, {"gravity_direction_lateral", "-", true}};
  static constexpr Role ports[] = {{"pitching_moment", "N m"}, {"lateral_moment", "N m", true}};
  static constexpr const char* constants[] = {"m", "R_cp"};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    constexpr double standard_gravity = 9.80665;
    F[0] = in.k[0] * standard_gravity * in.k[1] * in.q[0];
    F[1] = in.k[0] * standard_gravity * in.k[1] * in.q[1];
  }

  static std::vector<Example> examples() {
    return {{{0.206, 3.15}, {1.0, 0.0}, {}, {}, 0.0, {6.3635352, 0.0}, {}, "0.206 x 9.80665 x 3.15 = 6.36354 N m"},
            {{2.0, 1.0}, {0.5, -0.25}, {}, {}, 0.0, {9.80665, -4.903325}, {}, "by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(gravity, Gravity)
