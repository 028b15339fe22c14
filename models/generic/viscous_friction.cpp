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

  enum Quantity { rate, rate_lateral };
  static constexpr Role quantities[] = {{.name = "rate", .unit = "*"},
                                        {.name = "rate_lateral", .unit = "*", .optional = true, .completes = "rate"}};
  enum Port { port, port_lateral };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"},
                                   {.name = "port_lateral", .unit = "*", .optional = true, .completes = "port"}};
  enum Coefficient { viscosity };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "viscosity",
       .unit = "{port}/{rate}",
       .lower = 0.0,
       .upper = 1e15,
       .scale = 1.0,
       .doc = "force per rate; positive takes energy out"},
  };
  static constexpr bool dissipative = true;

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = -in.c[viscosity] * in.q[rate];
    F[port_lateral] = -in.c[viscosity] * in.q[rate_lateral];
  }

  static std::vector<Example> examples() {
    return {{.quantities = {2.0, 0.0}, .coefficients = {0.75}, .ports = {-1.5, 0.0}, .source = "by hand: 0.75 x 2, against the rate"},
            {.quantities = {-0.4, 0.3},
             .coefficients = {5.0},
             .ports = {2.0, -1.5},
             .source = "by hand: 5 x 0.4 and 5 x 0.3, against the rate"}};
  }
};

}  // namespace

MISFIT_EFFECT(viscous_friction, ViscousFriction)
