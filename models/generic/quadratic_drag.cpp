#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Drag with the square of the rate, against it: a body in air or water, an orifice. Where the system has a second rate across the first,
/// it opposes the motion as a whole.
struct QuadraticDrag {
  static constexpr const char* formula = "F = -drag |rate| rate";
  static constexpr const char* symbols = "drag [port/rate^2], rate of the motion along the port(s) [any]";
  static constexpr const char* valid =
      "separated flow at a steady drag coefficient (Reynolds numbers of 1e3 to 1e5 for a sphere); the medium at rest";
  static constexpr const char* size = "a ball of 10 cm in air: 0.5 x 1.2 kg/m^3 x 0.47 x 0.00785 m^2 = 0.0022 N s^2/m^2, 0.22 N at 10 m/s";
  static constexpr const char* source = "Newton, Principia II, prop. 33; Hoerner, Fluid-Dynamic Drag (1965)";
  static constexpr const char* excludes = "a moving medium, added mass, the linear part (viscous_friction)";
  static constexpr bool dissipative = true;
  static constexpr Role quantities[] = {{"rate", "*"}, {"rate_lateral", "*", true, false, "rate"}};
  static constexpr Role ports[] = {{"port", "*"}, {"port_lateral", "*", true, false, "port"}};
  static constexpr CoefficientSpec coefficients[] = {{"drag", CoefficientKind::strength, 0.0, "{port}/{rate}/{rate}", 0.0, 1e6, 0.1,
                                                      "force per square of the rate; positive takes energy out"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::sqrt;
    const T squared = in.q[0] * in.q[0] + in.q[1] * in.q[1];
    const T fast = value_of(squared) > 0.0 ? T(sqrt(squared)) : T(0.0);  // at rest the product has slope 0, whatever the direction
    F[0] = -in.c[0] * fast * in.q[0];
    F[1] = -in.c[0] * fast * in.q[1];
  }

  static std::vector<Example> examples() {
    return {{{}, {10.0, 0.0}, {0.0022}, {}, 0.0, {-0.22, 0.0}, {}, "the ball of `size`: 0.0022 x 100"},
            {{}, {-3.0, 4.0}, {0.005}, {}, 0.0, {0.075, -0.1}, {}, "|rate| = 5: 0.005 x 5 x (3, -4)"}};
  }
};

}  // namespace

MISFIT_EFFECT(quadratic_drag, QuadraticDrag)
