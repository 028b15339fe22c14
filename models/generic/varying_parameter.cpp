#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A parameter of the model is no constant: it changes with a state or an input, wherever it stands. A reaction is
/// faster where it is warm, in the balance of mass and of heat alike; heat goes over better between two streams that flow faster; a
/// friction falls as the oil warms.
struct VaryingParameter {
  static constexpr const char* formula = "F = slope (exp(growth (with - middle)) - 1)/growth, slope (with - middle) where growth = 0";
  static constexpr const char* symbols =
      "slope [parameter/with], parameter of the system [any], with: a state, or an input as recorded [any], middle: where the parameter "
      "has "
      "the value that the model gives it [with], fixed, growth [1/with] of the slope relative to itself: fixed at 0 unless it is needed";
  static constexpr const char* valid =
      "a parameter that changes in proportion to `with` in the range visited, or grows or fades exponentially; not a hump";
  static constexpr const char* size = "a rate constant of 0.05 1/min with 73 kJ/mol at 350 K: 7 % per K, 0.0035 1/min/K";
  static constexpr const char* source =
      "Young, Data-based mechanistic modelling (1998): state dependent parameters; Arrhenius: d ln k/dT = E/(R T^2)";
  static constexpr const char* excludes =
      "a change with time (drift) or with the past; a factor of one state or input in one equation (its change is bilinear)";

  enum Quantity { with };
  static constexpr Role quantities[] = {{.name = "with", .unit = "*"}};
  enum Port { parameter };
  static constexpr Role ports[] = {{.name = "parameter", .unit = "*"}};
  enum Coefficient { slope, middle, growth };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "slope",
       .unit = "{parameter}/{with}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "change of the parameter per change of `with`"},
      {.name = "middle",
       .kind = CoefficientKind::shape,
       .value = 0.0,
       .unit = "{with}",
       .lower = -1e12,
       .upper = 1e12,
       .scale = 1.0,
       .doc = "where the parameter has its own value",
       .fixed = true,
       .scan = {.from = 0.5, .to = 0.5, .count = 1, .over = "with"}},
      {.name = "growth",
       .kind = CoefficientKind::shape,
       .value = 0.0,
       .unit = "1/{with}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "relative change of the slope per change of `with`",
       .fixed = true,
       .drift_of = "slope"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T away = in.q[with] - in.c[middle];
    F[parameter] = in.c[slope] * away * expm1_over(in.c[growth] * away);
  }

  static std::vector<Example> examples() {
    return {
        {.quantities = {351.0},
         .coefficients = {0.0035, 350.0, 0.0},
         .ports = {0.0035},
         .source = "Arrhenius: 0.05 x 73000/(8.314 x 350^2) = 0.00358 per K, here 0.0035"},
        {.quantities = {-3.0}, .coefficients = {0.25, 1.0, 0.5}, .t = 2.0, .ports = {-0.43233236}, .source = "0.25 x (exp(-2) - 1)/0.5"}};
  }
};

}  // namespace

MISFIT_EFFECT(varying_parameter, VaryingParameter)
