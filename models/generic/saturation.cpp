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
      "unequal limits, integrator wind-up; a limited level is an overflow, a limited output sensor_saturation";

  enum Quantity { input };
  static constexpr Role quantities[] = {{.name = "input", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { saturated_gain, limit };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "saturated_gain",
       .unit = "{port}/{input}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "force per input that is lost beyond the limit",
       .whole = 1.0,
       .whole_of = "input"},
      {.name = "limit",
       .kind = CoefficientKind::shape,
       .value = 1.0,
       .unit = "{input}",
       .lower = 0.0,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "largest input that acts",
       .scan = {.from = 0.4, .to = 0.95, .count = 5, .over = "|input|"}},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = -in.c[saturated_gain] * beyond(in.q[input], in.c[limit]);
  }

  static std::vector<Example> examples() {
    return {{.quantities = {12.0}, .coefficients = {0.5, 10.0}, .ports = {-1.0}, .source = "by hand: 0.5 x 2 too much"},
            {.quantities = {-3.0}, .coefficients = {4.0, 2.0}, .ports = {4.0}, .source = "by hand: 4 x 1 below -2"},
            {.quantities = {1.0}, .coefficients = {4.0, 2.0}, .ports = {0.0}, .source = "within the limits"}};
  }
};

}  // namespace

MISFIT_EFFECT(saturation, Saturation)
