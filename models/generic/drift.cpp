#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A force, or a parameter of the system, that changes slowly and evenly: a zero that wanders, something that warms up; a heat exchanger
/// that fouls, a catalyst that ages.
struct Drift {
  static constexpr const char* formula = "F = drift (t - drift_origin)";
  static constexpr const char* symbols = "drift [port/s], t time of the recording [s], drift_origin where it is 0 [s]";
  static constexpr const char* valid = "a drift that is even over the recording; of a parameter, beside its value at drift_origin";
  static constexpr const char* size = "1 N m over a minute: 0.017 N m/s";
  static constexpr const char* source = "first term of the Taylor series in time";
  static constexpr const char* excludes =
      "wandering in both directions, drift of an effect's coefficient (give that coefficient a curve), a sensor that fades (sensor_fading)";

  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*", .parameter_too = true}};
  enum Coefficient { drift, drift_origin };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "drift",
       .unit = "{port}/s",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.01,
       .doc = "growth of the force, or of the parameter"},
      {.name = "drift_origin",
       .kind = CoefficientKind::shape,
       .value = 0.0,
       .unit = "s",
       .lower = -1e12,
       .upper = 1e12,
       .scale = 1.0,
       .doc = "time at which it is 0",
       .fixed = true},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = in.c[drift] * (in.t - in.c[drift_origin]);
  }

  static std::vector<Example> examples() {
    return {{.coefficients = {0.5, 2.0}, .t = 10.0, .ports = {4.0}, .source = "by hand: 0.5 x 8"},
            {.coefficients = {-200.0 / 86400.0, 0.0},
             .t = 43200.0,
             .ports = {-100.0},
             .source = "fouling by 200 W/K a day: Kern and Seaton (1959)"},
            {.coefficients = {-0.1, -5.0}, .t = 15.0, .ports = {-2.0}, .source = "by hand: -0.1 x 20"}};
  }
};

}  // namespace

MISFIT_EFFECT(drift, Drift)
