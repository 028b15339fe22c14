#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Friction that is higher at the start of the motion: the excess over the sliding friction, which rises with it over its width and has
/// faded at some times that. It needs coulomb_friction in the model, whose width it shares: by itself it would be taken for friction with a
/// width of its own.
struct StribeckFriction {
  static constexpr const char* formula = "F = -breakaway (tanh(|rate|/width) - tanh(|rate|/(stribeck_ratio width))) rate/|rate|";
  static constexpr const char* symbols =
      "breakaway excess [port], stribeck_ratio of the rate where it has faded to the width [-], width of coulomb_friction [rate], rate "
      "along the port(s) [any]";
  static constexpr const char* valid = "boundary and mixed lubrication; below the width the bearing creeps instead of sticking";
  static constexpr const char* size = "a dry bearing: 10 to 50 % of its sliding friction, below some deg/s";
  static constexpr const char* source =
      "Makkar, Dixon, Sawyer, Hu, IEEE/ASME AIM (2005): tanh(g2 v) - tanh(g3 v) as the Stribeck part of a smooth friction";
  static constexpr const char* excludes = "the sliding friction itself (coulomb_friction), sticking, memory of the contact (hysteresis)";
  static constexpr bool dissipative = true;
  static constexpr Role quantities[] = {{"rate", "*"}, {"inertia", "*", true}, {"rate_lateral", "*", true, false, "rate"}};
  static constexpr Role ports[] = {{"port", "*"}, {"port_lateral", "*", true, false, "port"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"breakaway", CoefficientKind::strength, 0.0, "{port}", 0.0, 1e6, 1.0,
       "size of the excess; its peak is 0.30, 0.61, 0.82 of it at a ratio of 2, 5, 14"},
      scanned({"stribeck_ratio", CoefficientKind::shape, 5.0, "-", 1.01, 1e3, 1.0,
               "rate at which the excess has fallen to a quarter of `breakaway`, over the width"},
              {2.0, 14.0, 4}),
      borrowed_coefficient("width", "{rate}", "smoothing of coulomb_friction", 0.1, 1e-6)};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T along = in.q[0] / in.c[2], across = in.q[2] / in.c[2];
    const T s = along * along + across * across;
    const T slow = 1.0 / in.c[1];
    // tanh a - tanh b = tanh(a - b) (1 - tanh a tanh b): of two equal numbers never the wrong sign.
    const T fading = above(T(1.0 - slow * s * tanh_over(s) * tanh_over(T(slow * slow * s))));
    const T excess = in.c[0] * (1.0 - slow) * tanh_over(T((1.0 - slow) * (1.0 - slow) * s)) * fading;
    F[0] = -excess * along;
    F[1] = -excess * across;
  }

  /// Slope at rate 0 over the inertia, as for coulomb_friction.
  static double fastest_rate(const Reads<double, double>& in) {
    const double inertia = in.q[1] > 0.0 ? in.q[1] : 1.0;
    return in.c[0] * (1.0 - 1.0 / in.c[1]) / (in.c[2] * inertia);
  }

  static std::vector<Example> examples() {
    return {{{},
             {0.05, 5.0, 0.0},
             {8.0, 10.0, 0.01},
             {},
             0.0,
             {-4.30233652, 0.0},
             {},
             "8 (tanh(5) - tanh(0.5)) = 8 x (0.99990920 - 0.46211716)"},
            {{},
             {-0.3, 0.0, 0.4},
             {2.0, 5.0, 0.1},
             {},
             0.0,
             {0.285978336, -0.381304448},
             {},
             "|rate| = 0.5: 2 (tanh(5) - tanh(1)) x (-0.6, 0.8), against"}};
  }
};

}  // namespace

MISFIT_EFFECT(stribeck_friction, StribeckFriction)
