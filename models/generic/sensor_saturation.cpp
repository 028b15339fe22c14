#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor that reads no more than its range: above the ceiling, and below the floor where a study gives one, the reading stands still.
struct SensorSaturation {
  static constexpr const char* formula = "y = h + clipped (clamp(h, floor, ceiling) - h)";
  static constexpr const char* symbols =
      "h predicted reading [output], clipped share [-] (1: the reading stands still beyond), ceiling, floor [output]";
  static constexpr const char* valid =
      "a range that is left as it is entered; the derivative at the corner is that of the side the reading is on";
  static constexpr const char* size = "readings of 10.5 V at a ceiling of 10 V are 0.5 V too high without it";
  static constexpr const char* source = "JCGM 200:2012 (VIM), 4.7: measuring interval";
  static constexpr const char* excludes = "a level that is itself limited (overflow)";
  static constexpr Role quantities[] = {{"reading", "*"}};
  static constexpr Role ports[] = {{"output", "{reading}"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"clipped", CoefficientKind::strength, 0.0, "-", 0.0, 1.0, 0.1, "share of what lies beyond the range that is not read"},
      scanned({"ceiling", CoefficientKind::shape, 1.0, "{output}", -1e9, 1e9, 0.1, "highest reading"}, {0.6, 0.99, 6, "reading"}),
      held({"floor", CoefficientKind::shape, -1e9, "{output}", -1e9, 1e9, 0.1, "lowest reading; -1e9: none"})};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[0] = in.c[0] * (above(T(in.c[2] - in.q[0])) - above(T(in.q[0] - in.c[1])));
  }

  static std::vector<Example> examples() {
    return {{{}, {10.5}, {1.0, 10.0, 0.5}, {}, 0.0, {-0.5}, {}, "by hand: cut to 10"},
            {{}, {-2.0}, {0.5, 3.0, -1.0}, {}, 0.0, {0.5}, {}, "by hand: half of what lies below -1"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_saturation, SensorSaturation)
