#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor with a clock of its own: what it measures was there at another time than its stamp says. The state is carried to that time by
/// the equations, so it may be earlier as well as later.
struct SensorClock {
  static constexpr const char* formula = "y(t) = h(x(t + sensor_offset + clock_rate t))";
  static constexpr const char* symbols =
      "h predicted output, sensor_offset at the recording's time 0 [s], clock_rate by which the clock is too slow [-]";
  static constexpr const char* valid = "offsets within which the random force and what drives unseen change little";
  static constexpr const char* size = "20 ms at 1 rad/s: 2 % of the amplitude, 90 deg before it; 1e-4 of clock_rate: 0.1 s after 1000 s";
  static constexpr const char* source = "definition";
  static constexpr const char* excludes = "a clock that is off for all channels (time_offset), jumps of a clock";

  enum Port { time_of_output };
  static constexpr Role ports[] = {{.name = "time_of_output", .unit = "s"}};
  enum Coefficient { sensor_offset, clock_rate };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "sensor_offset",
       .unit = "s",
       .lower = -1e6,
       .upper = 1e6,
       .scale = 0.01,
       .doc = "how much later than its stamp a measurement is",
       .lower_as_candidate = 0.0,
       .steps_as_candidate = 40.0},
      {.name = "clock_rate", .unit = "-", .lower = -0.1, .upper = 0.1, .scale = 1e-4, .doc = "growth of the offset with time"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[time_of_output] = in.c[sensor_offset] + in.c[clock_rate] * in.t;
  }

  static std::vector<Example> examples() {
    return {{.coefficients = {0.02, 1e-3}, .t = 5.0, .ports = {0.025}, .source = "0.02 + 0.001 x 5"},
            {.coefficients = {-0.5, 0.1}, .t = 2.0, .ports = {-0.3}, .source = "by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_clock, SensorClock)
