#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor with inertia: its output follows what it measures.
struct SensorLag {
  static constexpr const char* formula = "y = h + share (z - h), z' = (h - z)/sensor_tau";
  static constexpr const char* symbols = "h predicted output, z lagged output [output], share of the lagged part [-], sensor_tau [s]";
  static constexpr const char* valid = "first-order sensors: thermometers, filters";
  static constexpr const char* size = "share = 1: the whole output lags by sensor_tau";
  static constexpr const char* source = "first-order filter: Doebelin, Measurement Systems, section 3.3";
  static constexpr const char* excludes = "pure delay (sensor_delay), filters of higher order";

  enum Quantity { signal };
  static constexpr Role quantities[] = {{.name = "signal", .unit = "*"}};
  enum Port { output };
  static constexpr Role ports[] = {{.name = "output", .unit = "{signal}"}};
  enum Coefficient { share, sensor_tau };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "share", .unit = "-", .lower = -2.0, .upper = 2.0, .scale = 0.1, .doc = "lagged part of the output", .whole = 1.0},
      {.name = "sensor_tau",
       .kind = CoefficientKind::shape,
       .value = 0.05,
       .unit = "s",
       .lower = 1e-9,
       .upper = 1e9,
       .scale = 0.05,
       .doc = "time constant",
       .scan = {.from = 1.0, .to = 20.0, .count = 4, .over = "step"}},
  };
  enum State { z };
  static constexpr OwnStateSpec states[] = {{.name = "z", .unit = "{output}"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y, T* drift) {
    const T ahead = in.q[signal] - in.z[z];
    y[output] = -in.c[share] * ahead;
    drift[z] = ahead / in.c[sensor_tau];
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[sensor_tau]; }

  static std::vector<Example> examples() {
    return {{.quantities = {2.0},
             .coefficients = {0.5, 0.1},
             .states = {1.0},
             .ports = {-0.5},
             .drifts = {10.0},
             .source = "0.5 (1 - 2); (2 - 1)/0.1"},
            {.quantities = {-1.0}, .coefficients = {1.0, 0.5}, .states = {1.0}, .ports = {2.0}, .drifts = {-4.0}, .source = "by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_lag, SensorLag)
