#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Breakaway (Stribeck) friction: what dry friction is higher by at small rates than when sliding. With the rate it rises as the smoothed
/// step of coulomb_friction does, over the same width, and falls back to 0 over a width stribeck_ratio times as large. It is an addition to
/// coulomb_friction and shares its width; without that effect in the model it could not be told from dry friction with another width.
struct StribeckFriction {
  static constexpr const char* formula = "F = -breakaway (tanh(|rate|/width) - tanh(|rate|/(stribeck_ratio width))) rate/|rate|";
  static constexpr const char* symbols =
      "breakaway size of the excess [port], stribeck_ratio of the rates over which it falls and rises [-], width of coulomb_friction "
      "[rate], rate along the port(s) [any]";
  static constexpr const char* valid =
      "boundary and mixed lubrication; at rates below the width it acts as a viscous friction: there is no true sticking";
  static constexpr const char* size = "a dry bearing: 10 to 50 % of its sliding friction, below some deg/s";
  static constexpr const char* source =
      "Makkar, Dixon, Sawyer, Hu, IEEE/ASME AIM (2005): tanh(g2 v) - tanh(g3 v) as the Stribeck part of a smooth friction";
  static constexpr const char* excludes = "the sliding friction itself (coulomb_friction), sticking, memory of the contact (hysteresis)";
  static constexpr bool dissipative = true;

  enum Quantity { rate, rate_lateral };
  static constexpr Role quantities[] = {{.name = "rate", .unit = "*"},
                                        {.name = "rate_lateral", .unit = "*", .optional = true, .completes = "rate"}};
  enum Port { port, port_lateral };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"},
                                   {.name = "port_lateral", .unit = "*", .optional = true, .completes = "port"}};
  enum Coefficient { breakaway, stribeck_ratio, width };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "breakaway",
       .unit = "{port}",
       .lower = 0.0,
       .upper = 1e15,
       .scale = 1.0,
       .doc = "size of the excess over the sliding friction; the largest excess is 0.30, 0.61, 0.82 of it at a ratio of 2, 5, 14"},
      {.name = "stribeck_ratio",
       .kind = CoefficientKind::shape,
       .value = 5.0,
       .unit = "-",
       .lower = 1.01,
       .upper = 1e3,
       .scale = 1.0,
       .doc = "over the width: the rate at which the excess has fallen to a quarter of `breakaway`",
       .scan = {.from = 2.0, .to = 14.0, .count = 4}},
      {.name = "width",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "{rate}",
       .lower = 1e-12,
       .upper = 1e12,
       .doc = "smoothing of coulomb_friction",
       .shared = true},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T along = in.q[rate] / in.c[width], across = in.q[rate_lateral] / in.c[width];
    const T s = along * along + across * across;
    const T slow = 1.0 / in.c[stribeck_ratio];
    // The difference of the formula as tanh a - tanh b = tanh(a - b) (1 - tanh a tanh b), which rounding cannot give the wrong sign.
    const T fading = above(T(1.0 - slow * s * tanh_over(s) * tanh_over(T(slow * slow * s))));
    const T excess = in.c[breakaway] * (1.0 - slow) * tanh_over(T((1.0 - slow) * (1.0 - slow) * s)) * fading;
    F[port] = -excess * along;
    F[port_lateral] = -excess * across;
  }

  /// Slope of the force at rate 0, times `response`, the acceleration per unit force; as for coulomb_friction.
  static double fastest_rate(const Reads<double, double>& in, double response) {
    return in.c[breakaway] * (1.0 - 1.0 / in.c[stribeck_ratio]) / in.c[width] * response;
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.05, 0.0},
             .coefficients = {8.0, 10.0, 0.01},
             .ports = {-4.30233652, 0.0},
             .source = "8 (tanh(5) - tanh(0.5)) = 8 x (0.99990920 - 0.46211716)"},
            {.quantities = {-0.3, 0.4},
             .coefficients = {2.0, 5.0, 0.1},
             .ports = {0.285978336, -0.381304448},
             .source = "|rate| = 0.5: 2 (tanh(5) - tanh(1)) x (-0.6, 0.8), against"}};
  }
};

}  // namespace

MISFIT_EFFECT(stribeck_friction, StribeckFriction)
