#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A scale error that may be a curve of the predicted reading itself: what a lens does.
struct SensorScale {
  static constexpr const char* formula = "y = h (1 + scale_error)";
  static constexpr const char* symbols = "h predicted reading [output], scale_error [-]";
  static constexpr const char* valid = "always";
  static constexpr const char* size = "1 % of the reading for 0.01";
  static constexpr const char* source = "definition";
  static constexpr const char* excludes = "offset";
  static constexpr Role quantities[] = {{"reading", "*"}};
  static constexpr Role ports[] = {{"output", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"scale_error", CoefficientKind::strength, 0.0, "-", -1.0, 1.0, 0.01, "relative error"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[0] = in.c[0] * in.q[0];
  }

  static std::vector<Example> examples() {
    return {{{}, {3.0}, {0.02}, {}, 0.0, {0.06}, {}, "2 % of 3"}, {{}, {-5.0}, {0.1}, {}, 0.0, {-0.5}, {}, "by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_scale, SensorScale)
