#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A parameter of the model changes slowly and evenly with time, in all the equations in which it stands: a heat exchanger that fouls, a
/// catalyst that ages, a tyre that warms up.
struct DriftingParameter {
  static constexpr const char* formula = "F = change (t - change_origin)";
  static constexpr const char* symbols =
      "change [parameter/s], parameter of the system that stands in several of its equations [any], t time of the recording [s], "
      "change_origin where the parameter has the value that the model gives it [s]";
  static constexpr const char* valid = "a change that is even over the recording, and small beside the parameter";
  static constexpr const char* size = "2000 W/K that fall by a tenth in a day: -0.0023 W/K/s";
  static constexpr const char* source = "first term of the Taylor series in time; fouling: Kern and Seaton (1959)";
  static constexpr const char* excludes =
      "a change with a state or an input (varying_parameter), one that levels off, a force that drifts (drift)";

  enum Port { parameter };
  static constexpr Role ports[] = {{.name = "parameter", .unit = "*"}};
  enum Coefficient { change, change_origin };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "change", .unit = "{parameter}/s", .lower = -1e15, .upper = 1e15, .scale = 0.01, .doc = "change of the parameter with time"},
      {.name = "change_origin",
       .kind = CoefficientKind::shape,
       .value = 0.0,
       .unit = "s",
       .lower = -1e12,
       .upper = 1e12,
       .scale = 1.0,
       .doc = "time at which the parameter has its own value",
       .fixed = true},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[parameter] = in.c[change] * (in.t - in.c[change_origin]);
  }

  static std::vector<Example> examples() {
    return {{.coefficients = {-200.0 / 86400.0, 0.0}, .t = 43200.0, .ports = {-100.0}, .source = "half of a day of -200 W/K a day"},
            {.coefficients = {-0.1, -5.0}, .t = 15.0, .ports = {-2.0}, .source = "by hand: -0.1 x 20"}};
  }
};

}  // namespace

MISFIT_EFFECT(drifting_parameter, DriftingParameter)
