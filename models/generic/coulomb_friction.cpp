#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Dry friction: constant, against the motion. Smoothed over `width` about rate 0, where a real bearing would stick. Where the system has a
/// second rate across the first, friction opposes the rotation as a whole: one size, direction of the rate vector.
struct CoulombFriction {
  static constexpr const char* formula = "F = -friction tanh(|rate|/width) rate/|rate|";
  static constexpr const char* symbols = "friction [port], width of the smoothing [rate], rate of the motion along the port(s) [any]";
  static constexpr const char* valid = "rates that are mostly above the width; below it the bearing creeps instead of sticking";
  static constexpr const char* size = "20 N m at the swivel holds the parachute 1.4 deg away from its trim";
  static constexpr const char* source =
      "Andersson, Soderberg, Bjorklund, Tribology International 40 (2007): smooth Coulomb friction by tanh";
  static constexpr const char* excludes = "sticking, higher friction at the start of motion (Stribeck), viscous part (viscous_friction)";
  static constexpr Role quantities[] = {{"rate", "*"}, {"inertia", "*", true}, {"rate_lateral", "*", true, false, "rate"}};
  static constexpr Role ports[] = {{"port", "*"}, {"port_lateral", "*", true, false, "port"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"friction", CoefficientKind::strength, 0.0, "{port}", 0.0, 1e6, 1.0, "size of the friction when moving"},
      {"width", CoefficientKind::shape, 0.1, "{rate}", 1e-6, 1e6, 0.01, "rate at which the smoothed friction has 76 % of its size",
       Parity::none, "", false, true}};
  static constexpr bool dissipative = true;

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T along = in.q[0] / in.c[1], across = in.q[2] / in.c[1];
    const T friction = in.c[0] * tanh_over(T(along * along + across * across));
    F[0] = -friction * along;
    F[1] = -friction * across;
  }

  /// Slope at rate 0 over the inertia; a system without the quantity `inertia` has ports that are accelerations themselves.
  static double fastest_rate(const Reads<double, double>& in) {
    const double inertia = in.q[1] > 0.0 ? in.q[1] : 1.0;
    return in.c[0] / (in.c[1] * inertia);
  }

  static std::vector<Example> examples() {
    return {{{}, {0.01, 5.0, 0.0}, {20.0, 0.01}, {}, 0.0, {-15.2318831, 0.0}, {}, "20 tanh(1) = 20 x 0.761594156"},
            {{}, {-1.0, 0.0, 0.0}, {3.0, 0.02}, {}, 0.0, {3.0, 0.0}, {}, "fully sliding, against the motion"},
            {{}, {0.3, 0.0, -0.4}, {10.0, 0.5}, {}, 0.0, {-4.56956494, 6.09275325}, {}, "|rate| = 0.5: 10 tanh(1) x (0.6, -0.8), against"}};
  }
};

}  // namespace

MISFIT_EFFECT(coulomb_friction, CoulombFriction)
