#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor that reads no more than its range: above the ceiling, and below the floor where a study gives one, the output stands still.
struct SensorSaturation {
  static constexpr const char* formula = "y = h + clipped (clamp(h, floor, ceiling) - h)";
  static constexpr const char* symbols =
      "h predicted output [output], clipped share [-] (1: the output stands still beyond), ceiling, floor [output]";
  static constexpr const char* valid =
      "a range that is left as it is entered; the derivative at the corner is that of the side the output is on";
  static constexpr const char* size = "outputs of 10.5 V at a ceiling of 10 V are 0.5 V too high without it";
  static constexpr const char* source = "JCGM 200:2012 (VIM), 4.7: measuring interval";
  static constexpr const char* excludes = "a level that is itself limited (overflow)";

  enum Quantity { signal };
  static constexpr Role quantities[] = {{.name = "signal", .unit = "*"}};
  enum Port { output };
  static constexpr Role ports[] = {{.name = "output", .unit = "{signal}"}};
  enum Coefficient { clipped, ceiling, floor };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "clipped",
       .unit = "-",
       .lower = 0.0,
       .upper = 2.0,
       .scale = 0.1,
       .doc = "share of what lies beyond the range that is not read",
       .whole = 1.0},
      {.name = "ceiling",
       .kind = CoefficientKind::shape,
       .value = 1.0,
       .unit = "{output}",
       .lower = -1e12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "highest output",
       .scan = {.from = 0.6, .to = 0.99, .count = 6, .over = "signal"}},
      {.name = "floor",
       .kind = CoefficientKind::shape,
       .value = -1e9,
       .unit = "{output}",
       .lower = -1e12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "lowest output; -1e9: none",
       .fixed = true},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[output] = -in.c[clipped] * outside(in.q[signal], in.c[floor], in.c[ceiling]);
  }

  static std::vector<Example> examples() {
    return {{.quantities = {10.5}, .coefficients = {1.0, 10.0, 0.5}, .ports = {-0.5}, .source = "by hand: cut to 10"},
            {.quantities = {-2.0}, .coefficients = {0.5, 3.0, -1.0}, .ports = {0.5}, .source = "by hand: half of what lies below -1"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_saturation, SensorSaturation)
