#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor whose scale is wrong by a share of the reading; as a curve of the reading, its calibration curve.
struct SensorScale {
  static constexpr const char* formula = "y = h (1 + scale_error)";
  static constexpr const char* symbols = "h predicted reading [output], scale_error [-]";
  static constexpr const char* valid = "a scale that is constant over the recording";
  static constexpr const char* size = "1 % of the reading for 0.01";
  static constexpr const char* source = "JCGM 200:2012 (VIM), 4.12: sensitivity";
  static constexpr const char* excludes = "offset (bias), saturation";
  static constexpr Role quantities[] = {{"reading", "*"}};
  static constexpr Role ports[] = {{"output", "{reading}"}};
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
