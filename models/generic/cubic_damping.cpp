#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Damping that grows with the cube of the rate: the odd correction to linear damping where the flow does not separate.
struct CubicDamping {
  static constexpr const char* formula = "F = -cubic_damping rate^3";
  static constexpr const char* symbols = "cubic_damping [port/rate^3], rate of the motion along the port [any]";
  static constexpr const char* valid = "rates small enough for the next odd term to be small beside it";
  static constexpr const char* size =
      "yaw of a ship, T r' + r + a r^3 = K delta with a = 0.4 (s/deg)^2: a turn of 1.6 deg/s needs twice the rudder";
  static constexpr const char* source =
      "Norrbin, On the design and analysis of the zig-zag test, SSPA report B104-3 (1963); nonlinear Nomoto model";
  static constexpr const char* excludes = "separated flow (quadratic_drag), dry friction, an asymmetry";

  enum Quantity { rate };
  static constexpr Role quantities[] = {{.name = "rate", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { cubic_damping };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "cubic_damping",
       .unit = "{port}/{rate}/{rate}/{rate}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "force per cube of the rate; positive takes energy out",
       .lower_as_candidate = 0.0},  // less than none at high rates imitates dry friction
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = -in.c[CubicDamping::cubic_damping] * in.q[rate] * in.q[rate] * in.q[rate];
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.5}, .coefficients = {4.0}, .ports = {-0.5}, .source = "by hand: -4 x 0.125"},
            {.quantities = {-2.0}, .coefficients = {0.5}, .t = 1.0, .ports = {4.0}, .source = "by hand: -0.5 x -8"}};
  }
};

}  // namespace

MISFIT_EFFECT(cubic_damping, CubicDamping)
