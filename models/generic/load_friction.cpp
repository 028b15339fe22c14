#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Dry friction that grows with the load on what rubs: the teeth of a gear, a nut on its screw, a bearing under a weight. `load` is a
/// quantity of the model in the unit of the port (a torque over the same inertia). It needs coulomb_friction in the model, which has what
/// there is without load and whose width it shares.
struct LoadFriction {
  static constexpr const char* formula = "F = -load_factor |load| tanh(rate/width), |load| rounded over load_width";
  static constexpr const char* symbols =
      "load_factor friction per load [-], load what presses the rubbing parts together [port], width of coulomb_friction [rate], rate "
      "along the port [any], load_width [port]";
  static constexpr const char* valid =
      "rates that are mostly above the width, loads that do not change with the friction itself; below 1, or nothing moves under its load";
  static constexpr const char* size = "gears of a small servo: 0.1 to 0.4; a trapezoidal screw: above 0.5, so that it holds by itself";
  static constexpr const char* source =
      "M. Duclusaud, G. Passault, V. Padois, O. Ly, Extended friction models for the physics simulation of servo actuators (2024), "
      "arXiv 2410.08650: load-dependent friction";
  static constexpr const char* excludes = "friction without load (coulomb_friction), direct and reverse efficiency that differ, sticking";

  enum Quantity { rate, load };
  static constexpr Role quantities[] = {{.name = "rate", .unit = "*"}, {.name = "load", .unit = "{port}"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { load_factor, load_width, width };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "load_factor", .unit = "-", .lower = 0.0, .upper = 10.0, .scale = 0.1, .doc = "friction per load"},
      {.name = "load_width",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "{port}",
       .lower = 1e-12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "rounding of |load| about 0: a fiftieth of the largest load",
       .fixed = true,
       .scan = {.from = 0.02, .to = 0.02, .count = 1, .over = "|load|"}},
      {.name = "width",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "{rate}",
       .lower = 1e-12,
       .upper = 1e12,
       .doc = "smoothing of coulomb_friction",
       .shared = true},
  };
  static constexpr bool dissipative = true;

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::tanh;
    F[port] = -in.c[load_factor] * smooth_abs(in.q[load], in.c[load_width]) * tanh(T(in.q[rate] / in.c[width]));
  }

  /// Slope of the force at rate 0, times `response`, the acceleration per unit force; as for coulomb_friction.
  static double fastest_rate(const Reads<double, double>& in, double response) {
    return in.c[load_factor] * std::abs(in.q[load]) / in.c[width] * response;
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.05, -40.0},
             .coefficients = {0.25, 1.0, 0.1},
             .ports = {-4.62117157},
             .source = "0.25 x 40 tanh(0.5) = 10 x 0.462117157, against the motion"},
            {.quantities = {-3.0, 8.0},
             .coefficients = {0.5, 8.0, 0.1},
             .ports = {3.04637662},
             .source = "fully sliding backward: 0.5 x 8 tanh(1) = 4 x 0.761594156"}};
  }
};

}  // namespace

MISFIT_EFFECT(load_friction, LoadFriction)
