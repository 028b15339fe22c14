#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The input cannot change faster than a limit: a rudder gear, a servo valve, a motor controller with a ramp. What acts follows the
/// recorded command at that rate until it has reached it.
struct RateLimit {
  static constexpr const char* formula = "F = limited_gain (z - input), z' = clamp((input - z)/follow_time, -rate_limit, rate_limit)";
  static constexpr const char* symbols =
      "limited_gain [port/input]: the gain by which the model lets the input act, rate_limit largest rate [input/s], z what acts [input], "
      "follow_time [s] within which a slow command is followed, input as recorded [any]";
  static constexpr const char* valid =
      "one limit for both directions; commands that are faster and slower; z begins where the recording leaves it";
  static constexpr const char* size = "a rudder gear of 2.3 deg/s: 15 s for a step of 35 deg";
  static constexpr const char* source =
      "Van Amerongen, Adaptive steering of ships (1982): rudder dynamics with a limited rate; SOLAS II-1, regulation 29: 35 deg on one "
      "side "
      "to 30 deg on the other in 28 s";
  static constexpr const char* excludes = "a limited position (saturation), a linear lag (input_lag), other limits on the way back";

  enum Quantity { input };
  static constexpr Role quantities[] = {{.name = "input", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { limited_gain, rate_limit, follow_time };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "limited_gain",
       .unit = "{port}/{input}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "force per input that is still under way",
       .whole = 1.0,
       .whole_of = "input"},
      {.name = "rate_limit",
       .kind = CoefficientKind::shape,
       .value = 1.0,
       .unit = "{input}/s",
       .lower = 1e-12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "largest rate of what acts",
       .scan = {.from = 0.003, .to = 0.3, .count = 6, .over = "|input|/step"}},
      {.name = "follow_time",
       .kind = CoefficientKind::shape,
       .value = 0.01,
       .unit = "s",
       .lower = 1e-9,
       .upper = 1e9,
       .scale = 0.1,
       .doc = "time constant of following within the limit",
       .fixed = true,
       .scan = {.from = 0.5, .to = 32.0, .count = 4, .over = "step", .most_states = 2}},
  };
  enum State { z };
  static constexpr OwnStateSpec states[] = {{.name = "z", .unit = "{input}"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    const T behind = in.q[input] - in.z[z];
    const T wanted = behind / in.c[follow_time];
    F[port] = -in.c[limited_gain] * behind;
    drift[z] = wanted - beyond(wanted, in.c[RateLimit::rate_limit]);
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[follow_time]; }

  static std::vector<Example> examples() {
    return {{.quantities = {30.0},
             .coefficients = {2.0, 65.0 / 28.0, 0.5},
             .states = {-35.0},
             .ports = {-130.0},
             .drifts = {65.0 / 28.0},
             .source = "SOLAS II-1, regulation 29: 65 deg in 28 s; -2 x 65"},
            {.quantities = {1.0},
             .coefficients = {-4.0, 10.0, 0.02},
             .states = {1.1},
             .t = 2.0,
             .ports = {-0.4},
             .drifts = {-5.0},
             .source = "by hand: within the limit -0.1/0.02; 4 x -0.1"}};
  }
};

}  // namespace

MISFIT_EFFECT(rate_limit, RateLimit)
