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

  enum Quantity { rate };
  static constexpr Role quantities[] = {{.name = "rate", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { asymmetry, width };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "asymmetry",
       .unit = "{port}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 1.0,
       .doc = "friction forward less the mean of both directions"},
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
    using std::tanh;
    const T moving = tanh(T(in.q[rate] / in.c[width]));
    F[port] = -in.c[asymmetry] * moving * moving;
  }

  /// The steepest slope of tanh² is 4/(3 sqrt(3)) = 0.77.
  static double fastest_rate(const Reads<double, double>& in, double response) {
    constexpr double steepest = 0.77;
    return steepest * std::abs(in.c[asymmetry]) / in.c[width] * response;
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.1}, .coefficients = {6.0, 0.1}, .ports = {-3.48015401}, .source = "6 tanh(1)^2 = 6 x 0.580025669"},
            {.quantities = {-5.0},
             .coefficients = {-2.0, 0.1},
             .ports = {2.0},
             .source = "backward at full size: less friction where asymmetry is positive"}};
  }
};

}  // namespace

MISFIT_EFFECT(directional_friction, DirectionalFriction)
