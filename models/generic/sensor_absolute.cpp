#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor that cannot tell the sign: a rectifier, a speed from a toothed wheel, a magnitude.
struct SensorAbsolute {
  static constexpr const char* formula = "y = h + folded (|h| - h), |h| rounded over fold_width";
  static constexpr const char* symbols = "h predicted reading [output], folded share [-] (1: the size alone is read), fold_width [output]";
  static constexpr const char* valid = "readings that are mostly larger than the width";
  static constexpr const char* size = "twice the reading wherever it is negative";
  static constexpr const char* source = "definition";
  static constexpr const char* excludes = "a sign that is lost at random";
  static constexpr Role quantities[] = {{"reading", "*"}};
  static constexpr Role ports[] = {{"output", "{reading}"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"folded", CoefficientKind::strength, 0.0, "-", 0.0, 1.0, 0.1, "share of the sign that is lost"},
      held(scanned({"fold_width", CoefficientKind::shape, 0.05, "{output}", 1e-9, 1e9, 0.05, "rounding about 0"},
                   {0.02, 0.02, 1, "|reading|"}))};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[0] = in.c[0] * (smooth_abs(in.q[0], in.c[1]) - in.q[0]);
  }

  static std::vector<Example> examples() {
    return {{{}, {-2.0}, {1.0, 0.01}, {}, 0.0, {4.0}, {}, "reads 2 instead of -2"},
            {{}, {0.1}, {0.5, 0.1}, {}, 0.0, {-0.0119202922}, {}, "0.5 x 0.1 (tanh(1) - 1)"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_absolute, SensorAbsolute)
