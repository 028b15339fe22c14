#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The tunnel warms up or slows down: dynamic pressure that changes linearly over the recording, and the wind speed with its root.
struct DynamicPressureDrift {
  static constexpr const char* formula = "q = qbar + drift (t - t_drift)";
  static constexpr const char* symbols = "drift [Pa/s], t_drift time at which q = qbar [s], t time of the recording [s]";
  static constexpr const char* valid = "q stays positive over the recording";
  static constexpr const char* size = "0.5 Pa/s over 80 s: 40 Pa, 5 % of 736 Pa and of every moment";
  static constexpr const char* source = "definition; tunnels hold q to about 1 %";
  static constexpr const char* excludes = "gusts, unsteadiness faster than the recording";
  static constexpr const char* specialises = "drift";

  enum Port { dynamic_pressure };
  static constexpr Role ports[] = {{.name = "dynamic_pressure", .unit = "Pa"}};
  enum Coefficient { pressure_drift, t_drift };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "pressure_drift",
       .unit = "Pa/s",
       .lower = -1e4,
       .upper = 1e4,
       .scale = 0.5,
       .doc = "rate of change of the dynamic pressure"},
      {.name = "t_drift",
       .kind = CoefficientKind::shape,
       .value = 0.0,
       .unit = "s",
       .lower = -1e6,
       .upper = 1e6,
       .scale = 10.0,
       .doc = "time at which the dynamic pressure is the nominal one",
       .fixed = true},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    P[dynamic_pressure] = in.c[pressure_drift] * (in.t - in.c[t_drift]);
  }

  static std::vector<Example> examples() {
    return {{.coefficients = {0.5, 10.0}, .t = 90.0, .ports = {40.0}, .source = "0.5 Pa/s for 80 s"},
            {.coefficients = {-2.0, 4.0}, .t = 1.0, .ports = {6.0}, .source = "by hand: -2 x -3"}};
  }
};

}  // namespace

MISFIT_EFFECT(dynamic_pressure_drift, DynamicPressureDrift)
