#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor with as much range to either side: an accelerometer of +-2 g, an amplifier or a converter at full scale.
struct SensorRange {
  static constexpr const char* formula = "y = h + clipped (clamp(h, -range, range) - h)";
  static constexpr const char* symbols =
      "h predicted output [output], clipped share [-] (1: the output stands still beyond), range [output] to either side of 0";
  static constexpr const char* valid =
      "a range that is left as it is entered; the derivative at the corner is that of the side the output is on";
  static constexpr const char* size = "outputs of 2.1 g at a range of 2 g are 0.1 g too high without it";
  static constexpr const char* source = "JCGM 200:2012 (VIM), 4.7: measuring interval";
  static constexpr const char* excludes =
      "a range to one side, or about another middle (sensor_saturation), a motion that is itself limited";

  enum Quantity { signal };
  static constexpr Role quantities[] = {{.name = "signal", .unit = "*"}};
  enum Port { output };
  static constexpr Role ports[] = {{.name = "output", .unit = "{signal}"}};
  enum Coefficient { clipped, range };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "clipped",
       .unit = "-",
       .lower = 0.0,
       .upper = 2.0,
       .scale = 0.1,
       .doc = "share of what lies beyond the range that is not read",
       .whole = 1.0},
      {.name = "range",
       .kind = CoefficientKind::shape,
       .value = 1.0,
       .unit = "{output}",
       .lower = 1e-12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "largest output to either side",
       .scan = {.from = 0.4, .to = 0.98, .count = 6, .over = "|signal|"}},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    const T &h = in.q[signal], &edge = in.c[range];
    y[output] = in.c[clipped] * (above(T(-edge - h)) - above(T(h - edge)));
  }

  static std::vector<Example> examples() {
    return {{.quantities = {10.5}, .coefficients = {1.0, 10.0}, .ports = {-0.5}, .source = "by hand: cut to 10"},
            {.quantities = {-2.0}, .coefficients = {0.5, 1.2}, .ports = {0.4}, .source = "by hand: half of what lies below -1.2"},
            {.quantities = {0.7}, .coefficients = {1.0, 1.2}, .ports = {0.0}, .source = "within the range"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_range, SensorRange)
