#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The input does not act within a band about zero, and beyond it acts by as much less: a valve with overlap, the dead band of a motor's
/// amplifier. What the model lets pass too much is taken away.
struct InputDeadZone {
  static constexpr const char* formula = "F = -dead_gain clamp(input, -half_band, half_band)";
  static constexpr const char* symbols =
      "dead_gain [port/input]: the gain by which the model lets the input act, half_band of the inputs that do not act [input], input as "
      "recorded [any]";
  static constexpr const char* valid = "a band about zero, alike on both sides, without memory; inputs within it and beyond it";
  static constexpr const char* size = "a valve with an overlap of 5 % of its travel, open by 20 %: a quarter of the flow is lacking";
  static constexpr const char* source =
      "Merritt, Hydraulic Control Systems (1967), chapter 5: closed-centre valves; Khalil, Nonlinear "
      "Systems (2002), section 1.2.7";
  static constexpr const char* excludes =
      "unequal sides, play with memory (backlash), an input that is limited (saturation), a spring with clearance (dead_zone)";

  enum Quantity { input };
  static constexpr Role quantities[] = {{.name = "input", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { dead_gain, half_band };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "dead_gain",
       .unit = "{port}/{input}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "force per input that is lost within the band",
       .whole = 1.0,
       .whole_of = "input"},
      {.name = "half_band",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "{input}",
       .lower = 0.0,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "smallest input that acts",
       .scan = {.from = 0.05, .to = 0.6, .count = 5, .over = "|input|"}},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = -in.c[dead_gain] * (in.q[input] - beyond(in.q[input], in.c[half_band]));
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.2}, .coefficients = {3.0, 0.05}, .ports = {-0.15}, .source = "by hand: 3 x 0.05 is lacking"},
            {.quantities = {-0.7}, .coefficients = {2.0, 0.3}, .ports = {0.6}, .source = "by hand: 2 x 0.3 on the other side"},
            {.quantities = {0.02}, .coefficients = {3.0, 0.05}, .ports = {-0.06}, .source = "by hand: within the band all of 3 x 0.02"}};
  }
};

}  // namespace

MISFIT_EFFECT(input_dead_zone, InputDeadZone)
