#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// An output that comes late while the others do not: a slow bus, a video line. Second-order Pade approximation, since what an output was
/// before is in no recording; time_offset moves all outputs together, sensor_clock one of them, both exactly.
struct SensorDelay {
  static constexpr const char* formula =
      "y = h + late_share (h(t - tau) - h), h(t - tau) = h - tau z_rate; z' = z_rate, z_rate' = 12/tau^2 (h - z) - 6/tau z_rate";
  static constexpr const char* symbols =
      "h predicted output, z, z_rate filtered output and its rate, late_share of the output [-] (1: all of it), tau = sensor_delay [s]";
  static constexpr const char* valid = "outputs slower than 1.7/tau (phase to 1 %)";
  static constexpr const char* size = "20 ms at 1 rad/s: an error of 2 % of the amplitude, 90 deg behind the output";
  static constexpr const char* source = "Golub and Van Loan, Matrix Computations, 3rd ed., 11.3: Pade (2, 2) of exp(-tau s)";
  static constexpr const char* excludes = "a clock that is off for all channels (time_offset), delays that change";

  enum Quantity { signal };
  static constexpr Role quantities[] = {{.name = "signal", .unit = "*"}};
  enum Port { output };
  static constexpr Role ports[] = {{.name = "output", .unit = "{signal}"}};
  enum Coefficient { late_share, sensor_delay };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "late_share",
       .unit = "-",
       .lower = -2.0,
       .upper = 2.0,
       .scale = 0.1,
       .doc = "part of the output that comes late",
       .whole = 1.0},
      {.name = "sensor_delay",
       .kind = CoefficientKind::shape,
       .value = 0.05,
       .unit = "s",
       .lower = 1e-9,
       .upper = 1e9,
       .scale = 0.05,
       .doc = "by how much the output comes late",
       .scan = {.from = 1.0, .to = 20.0, .count = 4, .over = "step"}},
  };
  enum State { z, z_rate };
  static constexpr OwnStateSpec states[] = {{.name = "z", .unit = "{output}"}, {.name = "z_rate", .unit = "{output}/s"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y, T* drift) {
    const T& tau = in.c[sensor_delay];
    y[output] = -in.c[late_share] * tau * in.z[z_rate];
    drift[z] = in.z[z_rate];
    drift[z_rate] = (12.0 * (in.q[signal] - in.z[z]) / tau - 6.0 * in.z[z_rate]) / tau;
  }

  /// Its poles lie at |s| = sqrt(12)/tau.
  static double fastest_rate(const Reads<double, double>& in) { return 3.4641 / in.c[sensor_delay]; }

  static std::vector<Example> examples() {
    return {{.quantities = {3.0},
             .coefficients = {2.0, 0.5},
             .states = {2.0, 1.5},
             .ports = {-1.5},
             .drifts = {1.5, 30.0},
             .source = "-2 x 0.5 x 1.5; 12 x 1/0.25 - 6 x 1.5/0.5"},
            {.quantities = {1.0},
             .coefficients = {-1.0, 2.0},
             .states = {4.0, -0.25},
             .t = 1.0,
             .ports = {-0.5},
             .drifts = {-0.25, -8.25},
             .source = "by hand: 12 x -3/4 + 6 x 0.25/2"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_delay, SensorDelay)
