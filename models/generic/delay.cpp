#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The input acts later than it is recorded: transport, a slow valve, a computer. What was recorded before is read, so that it is exact:
/// lib/misfit/model/recorded_inputs.h. A delayed state is own states that approximate it, in the
/// equations of a declared system.
struct Delay {
  static constexpr const char* formula = "F = delayed_gain (u(t - tau) - u(t))";
  static constexpr const char* symbols =
      "delayed_gain [port/input]: the gain by which the model lets the input act, tau delay [s], u the input [any] as recorded: held or "
      "straight between its samples; before them a constant, which filter_error estimates, or its first value";
  static constexpr const char* valid =
      "any recorded input; jumps too. Counted from the recorded samples: an input that jumps between them acts up to a sampling interval "
      "earlier, on average half of one. Where an output shows a held input at once, the delay is known to one sampling interval only, "
      "whatever its sigma: within it the gains make up for it";
  static constexpr const char* size = "tau = 0.1 s at 1 rad/s: an error of 10 % of the input's amplitude, 90 deg behind it";
  static constexpr const char* source = "Ljung, System Identification, 2nd ed., 4.2: input delay n_k, here with fractions of a step";
  static constexpr const char* excludes = "delays that change, inputs that changed less than tau before the recording began";

  enum Quantity { input };
  static constexpr Role quantities[] = {{.name = "input", .unit = "*", .late_by = "delay"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { delayed_gain, delay };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "delayed_gain",
       .unit = "{port}/{input}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "force per input that comes late",
       .whole = 1.0,
       .whole_of = "input"},
      {.name = "delay",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "s",
       .lower = 1e-9,
       .upper = 1e9,
       .scale = 0.1,
       .doc = "delay",
       .scan = {.from = 0.5, .to = 40.0, .count = 14, .over = "step"}},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = in.c[delayed_gain] * (in.late(input, in.c[delay]) - in.q[input]);
  }

  static std::vector<Example> examples() {
    return {{.quantities = {3.0},
             .coefficients = {2.0, 0.5},
             .t = 2.0,
             .ports = {-1.0},
             .source = "by hand: 2 x (2.5 - 3), half way between 2 at 1 s and 3 at 2 s",
             .past_times = {0.0, 1.0, 2.0},
             .past_values = {1.0, 2.0, 3.0}},
            {.quantities = {4.0},
             .coefficients = {-1.0, 2.25},
             .t = 3.0,
             .ports = {3.25},
             .source = "by hand: -(0.75 - 4), a quarter before 1 s on the line from 0 to 1",
             .past_times = {0.0, 1.0, 3.0},
             .past_values = {0.0, 1.0, 4.0}}};
  }
};

}  // namespace

MISFIT_EFFECT(delay, Delay)
