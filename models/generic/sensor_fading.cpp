#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor whose scale changes slowly and evenly with time: a probe that fouls, a lamp that fades, a gauge that warms up.
struct SensorFading {
  static constexpr const char* formula = "y = h (1 + fading (t - fading_origin))";
  static constexpr const char* symbols =
      "h predicted output [output], fading [1/s], negative where the sensor shows less and less, t time of the recording [s], "
      "fading_origin "
      "where its scale is right [s]";
  static constexpr const char* valid = "a change that is even over the recording";
  static constexpr const char* size = "3 % in a day: 3.5e-7 1/s";
  static constexpr const char* source = "JCGM 200:2012 (VIM), 4.21: instrumental drift";
  static constexpr const char* excludes = "a zero that wanders (drift), a scale that was wrong from the beginning (sensor_scale)";

  enum Quantity { signal };
  static constexpr Role quantities[] = {{.name = "signal", .unit = "*"}};
  enum Port { output };
  static constexpr Role ports[] = {{.name = "output", .unit = "{signal}"}};
  enum Coefficient { fading, fading_origin };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "fading", .unit = "1/s", .lower = -1e9, .upper = 1e9, .scale = 1e-6, .doc = "relative change of the scale with time"},
      {.name = "fading_origin",
       .kind = CoefficientKind::shape,
       .value = 0.0,
       .unit = "s",
       .lower = -1e12,
       .upper = 1e12,
       .scale = 1.0,
       .doc = "time at which the scale is right",
       .fixed = true},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[output] = in.c[fading] * (in.t - in.c[fading_origin]) * in.q[signal];
  }

  static std::vector<Example> examples() {
    return {{.quantities = {2.0}, .coefficients = {-0.03 / 86400.0, 0.0}, .t = 43200.0, .ports = {-0.03}, .source = "half a day of -3 %"},
            {.quantities = {-5.0}, .coefficients = {0.1, 1.0}, .t = 3.0, .ports = {-1.0}, .source = "by hand: 0.1 x 2 x -5"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_fading, SensorFading)
