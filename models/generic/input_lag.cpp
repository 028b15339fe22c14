#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The input reaches the system through a first-order element that the model leaves out: an actuator, a valve, a winding, a filter.
struct InputLag {
  static constexpr const char* formula = "F = lagged_gain (z - input), z' = (input - z)/input_tau";
  static constexpr const char* symbols =
      "lagged_gain [port/input]: the gain by which the model lets the input act, input as recorded [any], z lagged input [input], "
      "input_tau time constant [s]";
  static constexpr const char* valid =
      "one time constant, which does not depend on the input's size or direction; z begins "
      "where the recording leaves it";
  static constexpr const char* size = "a winding of 20 mH and 1 Ohm: 20 ms, at 10 rad/s 2 % of the amplitude and 11 deg";
  static constexpr const char* source = "Ljung, System Identification (1999), 4.2: process models; first-order lag";
  static constexpr const char* excludes = "pure delay (delay), rate limits, a lag of the sensor (sensor_lag)";

  enum Quantity { input };
  static constexpr Role quantities[] = {{.name = "input", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { lagged_gain, input_tau };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "lagged_gain",
       .unit = "{port}/{input}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "force per input that comes through the lag",
       .whole = 1.0,
       .whole_of = "input"},
      {.name = "input_tau",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "s",
       .lower = 1e-9,
       .upper = 1e9,
       .scale = 0.1,
       .doc = "time constant",
       .scan = {.from = 1.0, .to = 20.0, .count = 4, .over = "step"}},
  };
  enum State { z };
  static constexpr OwnStateSpec states[] = {{.name = "z", .unit = "{input}"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    const T behind = in.z[z] - in.q[input];
    F[port] = in.c[lagged_gain] * behind;
    drift[z] = -behind / in.c[input_tau];
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[input_tau]; }

  static std::vector<Example> examples() {
    return {{.quantities = {3.0},
             .coefficients = {2.0, 0.5},
             .states = {2.0},
             .ports = {-2.0},
             .drifts = {2.0},
             .source = "by hand: 2 x (2 - 3); (3 - 2)/0.5"},
            {.quantities = {-1.0},
             .coefficients = {-4.0, 0.02},
             .states = {0.5},
             .t = 2.0,
             .ports = {-6.0},
             .drifts = {-75.0},
             .source = "by hand: -4 x 1.5; -1.5/0.02"}};
  }
};

}  // namespace

MISFIT_EFFECT(input_lag, InputLag)
