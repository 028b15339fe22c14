#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// An output that shows an input at once, beside what the states make of it: the voltage over the resistance of a battery, an accelerometer
/// beside the force that accelerates it. A model without it can follow a jump of the input only through a state that is as fast as the
/// sampling.
struct Feedthrough {
  static constexpr const char* formula = "y = h(x) + feedthrough input";
  static constexpr const char* symbols = "feedthrough [output/input], input as recorded [any], y the output [any]";
  static constexpr const char* valid = "within a sampling interval of the jump, in proportion";
  static constexpr const char* size = "a battery of 0.05 ohm: 0.1 V at 2 A, at once";
  static constexpr const char* source =
      "Ljung, System Identification (1999), 4.3: y = C x + D u; Plett, Battery Management Systems 1 (2015), 2.3: R0 i";
  static constexpr const char* excludes = "an action that is late by more than that (delay, input_lag), of a nonlinear resistance the rest";

  enum Quantity { input };
  static constexpr Role quantities[] = {{.name = "input", .unit = "*"}};
  enum Port { output };
  static constexpr Role ports[] = {{.name = "output", .unit = "*"}};
  enum Coefficient { feedthrough };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "feedthrough",
       .unit = "{output}/{input}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "output per input, at once, beside what the model has"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[output] = in.c[feedthrough] * in.q[input];
  }

  static std::vector<Example> examples() {
    return {{.quantities = {2.0}, .coefficients = {-0.05}, .ports = {-0.1}, .source = "by hand: 2 A through 0.05 ohm"},
            {.quantities = {-3.0}, .coefficients = {0.4}, .t = 5.0, .ports = {-1.2}, .source = "by hand: 0.4 x -3"}};
  }
};

}  // namespace

MISFIT_EFFECT(feedthrough, Feedthrough)
