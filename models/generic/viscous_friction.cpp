#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Friction proportional to a rate, and to a second one across it where the system has that: the lubricated part of a bearing, or any
/// linear damping that the model does not know yet.
struct ViscousFriction {
  static constexpr const char* formula = "F = -viscosity rate";
  static constexpr const char* symbols = "viscosity [port/rate], rate of the motion along the port(s) [any]";
  static constexpr const char* valid = "laminar film, small rates; the port must act along the rate";
  static constexpr const char* size = "1 N m s/rad at 1 rad/s: 1 N m; C_mq = -0.25 gives 12.8 N m there";
  static constexpr const char* source = "Rayleigh, The Theory of Sound I (1894), section 81: dissipation function F = c x'^2/2";
  static constexpr const char* excludes = "sticking (coulomb_friction), quadratic drag";
  static constexpr Role quantities[] = {{"rate", "*"}, {"rate_lateral", "*", true, false, "rate"}};
  static constexpr Role ports[] = {{"port", "*"}, {"port_lateral", "*", true, false, "port"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"viscosity", CoefficientKind::strength, 0.0, "{port}/{rate}", 0.0, 1e6, 1.0, "force per rate; positive takes energy out"}};
  static constexpr bool dissipative = true;

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[0] = -in.c[0] * in.q[0];
    F[1] = -in.c[0] * in.q[1];
  }

  static std::vector<Example> examples() {
    return {{{}, {2.0, 0.0}, {0.75}, {}, 0.0, {-1.5, 0.0}, {}, "by hand: 0.75 x 2, against the rate"},
            {{}, {-0.4, 0.3}, {5.0}, {}, 0.0, {2.0, -1.5}, {}, "by hand: 5 x 0.4 and 5 x 0.3, against the rate"}};
  }
};

}  // namespace

MISFIT_EFFECT(viscous_friction, ViscousFriction)
