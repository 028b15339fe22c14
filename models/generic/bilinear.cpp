#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// An input sets how strongly a state acts: a valve in a drain, the current of an adjustable damper, wind over a warm wall. So may another
/// state: pitch damping that grows with the angle of attack, a reaction faster where it is warm. What the input does by itself, or the
/// state, is in other effects (input_gain, viscous_friction, leak).
struct Bilinear {
  static constexpr const char* formula = "F = product input (factor - neutral)";
  static constexpr const char* symbols =
      "product [port/input/factor], input as recorded, or another state [any], factor: a state or a rate [any], neutral: its value at "
      "which the input does "
      "nothing [factor], fixed: the input's own gain tells the rest";
  static constexpr const char* valid = "an action in proportion to the input and to the distance of the factor from its neutral value";
  static constexpr const char* size = "a damper of 100 N s/m per ampere at 0.5 A and 0.2 m/s: 10 N against the motion";
  static constexpr const char* source = "Mohler, Bilinear Control Processes (1973): x' = A x + B u + u N x";
  static constexpr const char* excludes =
      "a difference of two levels times the input (bilinear_exchange), powers of input or state, a lag of the input (input_lag)";

  enum Quantity { input, factor };
  static constexpr Role quantities[] = {{.name = "input", .unit = "*"}, {.name = "factor", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { product, neutral };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "product",
       .unit = "{port}/{input}/{factor}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "force per input and factor"},
      {.name = "neutral",
       .kind = CoefficientKind::shape,
       .value = 0.0,
       .unit = "{factor}",
       .lower = -1e12,
       .upper = 1e12,
       .scale = 1.0,
       .doc = "factor at which the input does nothing",
       .fixed = true,
       .scan = {.from = 1.0, .to = 1.0, .count = 1, .over = "0 factor"}},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = in.c[product] * in.q[input] * (in.q[factor] - in.c[neutral]);
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.5, 0.2}, .coefficients = {-100.0, 0.0}, .ports = {-10.0}, .source = "by hand: -100 x 0.5 x 0.2"},
            {.quantities = {-3.0, 4.0}, .coefficients = {0.25, 1.0}, .t = 2.0, .ports = {-2.25}, .source = "by hand: 0.25 x -3 x (4 - 1)"}};
  }
};

}  // namespace

MISFIT_EFFECT(bilinear, Bilinear)
