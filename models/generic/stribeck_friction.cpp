#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Friction that is higher at the start of the motion: the excess over the sliding friction (coulomb_friction), which grows over a small
/// width, peaks, and is gone some stribeck_rate later. An increment of its own, so that one strength tells whether a bearing has it. As
/// there, it opposes the rotation as a whole where the system has a second rate across the first.
struct StribeckFriction {
  static constexpr const char* formula =
      "F = -breakaway (tanh(|rate|/width) - tanh(|rate|/stribeck_rate)) rate/|rate|, width = width_share stribeck_rate";
  static constexpr const char* symbols =
      "breakaway excess [port], stribeck_rate where it has faded [rate], width_share [-], rate of the motion along the port(s) [any]";
  static constexpr const char* valid = "boundary and mixed lubrication; below the width the bearing creeps instead of sticking";
  static constexpr const char* size = "a dry bearing: 10 to 50 % of its sliding friction, below some deg/s";
  static constexpr const char* source =
      "Makkar, Dixon, Sawyer, Hu, IEEE/ASME AIM (2005): tanh(g2 v) - tanh(g3 v) as the Stribeck part of a smooth friction";
  static constexpr const char* excludes = "the sliding friction itself (coulomb_friction), sticking, memory of the contact (hysteresis)";
  static constexpr bool dissipative = true;
  static constexpr Role quantities[] = {{"rate", "*"}, {"inertia", "*", true}, {"rate_lateral", "*", true, false, "rate"}};
  static constexpr Role ports[] = {{"port", "*"}, {"port_lateral", "*", true, false, "port"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"breakaway", CoefficientKind::strength, 0.0, "{port}", 0.0, 1e6, 1.0, "excess of the friction at the start of the motion"},
      scanned({"stribeck_rate", CoefficientKind::shape, 0.1, "{rate}", 1e-6, 1e6, 0.05, "rate at which the excess has fallen to a quarter"},
              {0.05, 0.4, 4, "|rate|"}),
      held({"width_share", CoefficientKind::shape, 0.1, "-", 0.01, 0.9, 0.05,
            "width of the smoothing about rate 0, as a share of stribeck_rate"})};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T along = in.q[0] / in.c[1], across = in.q[2] / in.c[1];
    const T s = along * along + across * across;
    const T steep = 1.0 / in.c[2];
    // tanh a - tanh b = tanh(a - b) (1 - tanh a tanh b): of two equal numbers never the wrong sign.
    const T fading = above(T(1.0 - steep * s * tanh_over(T(steep * steep * s)) * tanh_over(s)));
    const T excess = in.c[0] * (steep - 1.0) * tanh_over(T((steep - 1.0) * (steep - 1.0) * s)) * fading;
    F[0] = -excess * along;
    F[1] = -excess * across;
  }

  /// Slope at rate 0 over the inertia, as for coulomb_friction.
  static double fastest_rate(const Reads<double, double>& in) {
    const double inertia = in.q[1] > 0.0 ? in.q[1] : 1.0;
    return in.c[0] * (1.0 / in.c[2] - 1.0) / (in.c[1] * inertia);
  }

  static std::vector<Example> examples() {
    return {
        {{}, {0.05, 5.0, 0.0}, {8.0, 0.1, 0.1}, {}, 0.0, {-4.30233652, 0.0}, {}, "8 (tanh(5) - tanh(0.5)) = 8 x (0.99990920 - 0.46211716)"},
        {{},
         {-0.3, 0.0, 0.4},
         {2.0, 0.5, 0.2},
         {},
         0.0,
         {0.285978336, -0.381304448},
         {},
         "|rate| = 0.5: 2 (tanh(5) - tanh(1)) x (-0.6, 0.8), against"}};
  }
};

}  // namespace

MISFIT_EFFECT(stribeck_friction, StribeckFriction)
