#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Friction that differs between the two directions: half the difference of the two Coulomb levels. It needs coulomb_friction in the model,
/// which keeps the mean and whose width it shares.
struct DirectionalFriction {
  static constexpr const char* formula = "F = -asymmetry tanh(rate/width)^2";
  static constexpr const char* symbols =
      "asymmetry half the difference of the friction forward and backward [port], width of coulomb_friction [rate], rate along the port "
      "[any]";
  static constexpr const char* valid =
      "rates that are mostly above the width; friction forward is friction + asymmetry, backward friction - asymmetry";
  static constexpr const char* size = "a hydraulic cylinder with unequal seals: some 10 % of its friction";
  static constexpr const char* source =
      "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994), section 2: friction that depends on the direction";
  static constexpr const char* excludes = "the mean of both directions (coulomb_friction), unequal viscous parts";
  static constexpr Role quantities[] = {{"rate", "*"}, {"inertia", "*", true}};
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"asymmetry", CoefficientKind::strength, 0.0, "{port}", -1e6, 1e6, 1.0, "friction forward less the mean of both directions"},
      borrowed_coefficient("width", "{rate}", "smoothing of coulomb_friction", 0.1, 1e-6)};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::tanh;
    const T moving = tanh(T(in.q[0] / in.c[1]));
    F[0] = -in.c[0] * moving * moving;
  }

  /// The steepest slope of tanh² is 4/(3 sqrt(3)) = 0.77.
  static double fastest_rate(const Reads<double, double>& in) {
    constexpr double steepest = 0.77;
    const double inertia = in.q[1] > 0.0 ? in.q[1] : 1.0;
    return steepest * std::abs(in.c[0]) / (in.c[1] * inertia);
  }

  static std::vector<Example> examples() {
    return {{{}, {0.1, 2.0}, {6.0, 0.1}, {}, 0.0, {-3.48015401}, {}, "6 tanh(1)^2 = 6 x 0.580025669"},
            {{}, {-5.0, 0.0}, {-2.0, 0.1}, {}, 0.0, {2.0}, {}, "backward at full size: less friction where asymmetry is positive"}};
  }
};

}  // namespace

MISFIT_EFFECT(directional_friction, DirectionalFriction)
