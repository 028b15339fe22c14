#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor that reads no less than its floor: a flow meter that does not turn below some flow, an amplifier without a negative supply.
struct SensorFloor {
  static constexpr const char* formula = "y = h + clipped (max(h, floor) - h)";
  static constexpr const char* symbols =
      "h predicted output [output], clipped share [-] (1: the output stands still below), floor [output]";
  static constexpr const char* valid =
      "a floor that is left as it is reached; the derivative at the corner is that of the side the output is on";
  static constexpr const char* size = "outputs of -0.2 V at a floor of 0 V are 0.2 V too low without it";
  static constexpr const char* source = "JCGM 200:2012 (VIM), 4.7: measuring interval";
  static constexpr const char* excludes = "a ceiling (sensor_saturation; both: sensor_range), a motion that is itself limited";

  enum Quantity { signal };
  static constexpr Role quantities[] = {{.name = "signal", .unit = "*"}};
  enum Port { output };
  static constexpr Role ports[] = {{.name = "output", .unit = "{signal}"}};
  enum Coefficient { clipped, floor };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "clipped",
       .unit = "-",
       .lower = 0.0,
       .upper = 2.0,
       .scale = 0.1,
       .doc = "share of what lies below the floor that is not read",
       .whole = 1.0},
      {.name = "floor",
       .kind = CoefficientKind::shape,
       .unit = "{output}",
       .lower = -1e12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "lowest output",
       .scan = {.from = 0.01, .to = 0.4, .count = 6, .over = "signal"}},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[output] = in.c[clipped] * above(T(in.c[floor] - in.q[signal]));
  }

  static std::vector<Example> examples() {
    return {{.quantities = {-0.7}, .coefficients = {1.0, -0.5}, .ports = {0.2}, .source = "by hand: raised to -0.5"},
            {.quantities = {1.0}, .coefficients = {0.5, 3.0}, .ports = {1.0}, .source = "by hand: half of what lies below 3"},
            {.quantities = {4.0}, .coefficients = {1.0, 3.0}, .ports = {0.0}, .source = "above the floor"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_floor, SensorFloor)
