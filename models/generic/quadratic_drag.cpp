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

  enum Quantity { rate, rate_lateral };
  static constexpr Role quantities[] = {{.name = "rate", .unit = "*"},
                                        {.name = "rate_lateral", .unit = "*", .optional = true, .completes = "rate"}};
  enum Port { port, port_lateral };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"},
                                   {.name = "port_lateral", .unit = "*", .optional = true, .completes = "port"}};
  enum Coefficient { drag };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "drag",
       .unit = "{port}/{rate}/{rate}",
       .lower = 0.0,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "force per square of the rate; positive takes energy out"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::sqrt;
    const T squared = in.q[rate] * in.q[rate] + in.q[rate_lateral] * in.q[rate_lateral];
    const T fast = value_of(squared) > 0.0 ? T(sqrt(squared)) : T(0.0);  // at rest the product has slope 0, whatever the direction
    F[port] = -in.c[drag] * fast * in.q[rate];
    F[port_lateral] = -in.c[drag] * fast * in.q[rate_lateral];
  }

  static std::vector<Example> examples() {
    return {{.quantities = {10.0, 0.0}, .coefficients = {0.0022}, .ports = {-0.22, 0.0}, .source = "the ball of `size`: 0.0022 x 100"},
            {.quantities = {-3.0, 4.0}, .coefficients = {0.005}, .ports = {0.075, -0.1}, .source = "|rate| = 5: 0.005 x 5 x (3, -4)"}};
  }
};

}  // namespace

MISFIT_EFFECT(quadratic_drag, QuadraticDrag)
