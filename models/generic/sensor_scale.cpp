#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor whose scale is wrong by a share of the output; as a curve of the output, its calibration curve.
struct SensorScale {
  static constexpr const char* formula = "y = h (1 + scale_error)";
  static constexpr const char* symbols = "h predicted output [output], scale_error [-]";
  static constexpr const char* valid = "a scale that is constant over the recording";
  static constexpr const char* size = "1 % of the output for 0.01";
  static constexpr const char* source = "JCGM 200:2012 (VIM), 4.12: sensitivity";
  static constexpr const char* excludes = "offset (bias), saturation";

  enum Quantity { signal };
  static constexpr Role quantities[] = {{.name = "signal", .unit = "*"}};
  enum Port { output };
  static constexpr Role ports[] = {{.name = "output", .unit = "{signal}"}};
  enum Coefficient { scale_error };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "scale_error", .unit = "-", .lower = -1.0, .upper = 1.0, .scale = 0.01, .doc = "relative error"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[output] = in.c[scale_error] * in.q[signal];
  }

  static std::vector<Example> examples() {
    return {{.quantities = {3.0}, .coefficients = {0.02}, .ports = {0.06}, .source = "2 % of 3"},
            {.quantities = {-5.0}, .coefficients = {0.1}, .ports = {-0.5}, .source = "by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_scale, SensorScale)
