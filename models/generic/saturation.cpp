#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The input does not act beyond a limit: a pump at its end, an amplifier that clips. What the model lets pass too much is taken away.
struct Saturation {
  static constexpr const char* formula = "F = saturated_gain (clamp(input, -limit, limit) - input)";
  static constexpr const char* symbols =
      "saturated_gain [port/input]: the gain by which the model lets the input act, limit [input], input as recorded [any]";
  static constexpr const char* valid =
      "a symmetric limit, reached and left at once; the derivative at the corner is that of the side the input is on";
  static constexpr const char* size = "an input of 12 V at a limit of 10 V: a sixth of what it should do is lacking";
  static constexpr const char* source = "Khalil, Nonlinear Systems (2002), section 1.2.7";
  static constexpr const char* excludes =
      "unequal limits, integrator wind-up; a limited level is an overflow, a limited reading sensor_saturation";
  static constexpr Role quantities[] = {{"input", "*"}};
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"saturated_gain", CoefficientKind::strength, 0.0, "{port}/{input}", -1e12, 1e12, 0.1,
       "force per input that is lost beyond the limit"},
      scanned({"limit", CoefficientKind::shape, 1.0, "{input}", 0.0, 1e9, 0.1, "largest input that acts"}, {0.4, 0.95, 5, "|input|"})};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[0] = -in.c[0] * beyond(in.q[0], in.c[1]);
  }

  static std::vector<Example> examples() {
    return {{{}, {12.0}, {0.5, 10.0}, {}, 0.0, {-1.0}, {}, "by hand: 0.5 x 2 too much"},
            {{}, {-3.0}, {4.0, 2.0}, {}, 0.0, {4.0}, {}, "by hand: 4 x 1 below -2"},
            {{}, {1.0}, {4.0, 2.0}, {}, 0.0, {0.0}, {}, "within the limits"}};
  }
};

}  // namespace

MISFIT_EFFECT(saturation, Saturation)
