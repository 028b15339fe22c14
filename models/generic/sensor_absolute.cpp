#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor that measures without the sign: a rectifier, a speed from a toothed wheel, a magnitude.
struct SensorAbsolute {
  static constexpr const char* formula = "y = h + folded (|h| - h), |h| rounded over fold_width";
  static constexpr const char* symbols = "h predicted output [output], folded share [-] (1: the size alone is read), fold_width [output]";
  static constexpr const char* valid = "outputs that are mostly larger than the width";
  static constexpr const char* size = "twice the output wherever it is negative";
  static constexpr const char* source = "definition";
  static constexpr const char* excludes = "a sign that is lost at random";

  enum Quantity { signal };
  static constexpr Role quantities[] = {{.name = "signal", .unit = "*"}};
  enum Port { output };
  static constexpr Role ports[] = {{.name = "output", .unit = "{signal}"}};
  enum Coefficient { folded, fold_width };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "folded", .unit = "-", .lower = 0.0, .upper = 2.0, .scale = 0.1, .doc = "share of the sign that is lost", .whole = 1.0},
      {.name = "fold_width",
       .kind = CoefficientKind::shape,
       .value = 0.05,
       .unit = "{output}",
       .lower = 1e-12,
       .upper = 1e12,
       .scale = 0.05,
       .doc = "rounding about 0",
       .fixed = true,
       .scan = {.from = 0.02, .to = 0.02, .count = 1, .over = "|signal|", .smooths = true}},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[output] = in.c[folded] * (smooth_abs(in.q[signal], in.c[fold_width]) - in.q[signal]);
  }

  static std::vector<Example> examples() {
    return {{.quantities = {-2.0}, .coefficients = {1.0, 0.01}, .ports = {4.0}, .source = "reads 2 instead of -2"},
            {.quantities = {0.1}, .coefficients = {0.5, 0.1}, .ports = {-0.0119202922}, .source = "0.5 x 0.1 (tanh(1) - 1)"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_absolute, SensorAbsolute)
