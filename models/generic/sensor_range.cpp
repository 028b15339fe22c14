#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor that reads neither less than its floor nor more than its ceiling, both of which the motion passes: an accelerometer of +-2 g, a
/// converter of 0 to 5 V.
struct SensorRange {
  static constexpr const char* formula = "y = h + clipped (clamp(h, floor, ceiling) - h)";
  static constexpr const char* symbols =
      "h predicted output [output], clipped share [-] (1: the output stands still beyond), floor, ceiling [output]";
  static constexpr const char* valid =
      "a range that is left as it is entered; the derivative at the corner is that of the side the output is on";
  static constexpr const char* size = "outputs of 2.1 g at a ceiling of 2 g are 0.1 g too high without it";
  static constexpr const char* source = "JCGM 200:2012 (VIM), 4.7: measuring interval";
  static constexpr const char* excludes = "one end alone (sensor_saturation, sensor_floor), a motion that is itself limited";

  enum Quantity { signal };
  static constexpr Role quantities[] = {{.name = "signal", .unit = "*"}};
  enum Port { output };
  static constexpr Role ports[] = {{.name = "output", .unit = "{signal}"}};
  enum Coefficient { clipped, floor, ceiling };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "clipped",
       .unit = "-",
       .lower = 0.0,
       .upper = 2.0,
       .scale = 0.1,
       .doc = "share of what lies beyond the range that is not read",
       .whole = 1.0},
      {.name = "floor",
       .kind = CoefficientKind::shape,
       .value = -1.0,
       .unit = "{output}",
       .lower = -1e12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "lowest output",
       .scan = {.from = 0.02, .to = 0.3, .count = 4, .over = "signal"}},
      {.name = "ceiling",
       .kind = CoefficientKind::shape,
       .value = 1.0,
       .unit = "{output}",
       .lower = -1e12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "highest output",
       .scan = {.from = 0.7, .to = 0.98, .count = 4, .over = "signal"}},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[output] = -in.c[clipped] * outside(in.q[signal], in.c[floor], in.c[ceiling]);
  }

  static std::vector<Example> examples() {
    return {{.quantities = {10.5}, .coefficients = {1.0, 0.5, 10.0}, .ports = {-0.5}, .source = "by hand: cut to 10"},
            {.quantities = {-2.0}, .coefficients = {0.5, -1.2, 3.0}, .ports = {0.4}, .source = "by hand: half of what lies below -1.2"},
            {.quantities = {0.7}, .coefficients = {1.0, -1.2, 3.0}, .ports = {0.0}, .source = "within the range"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_range, SensorRange)
