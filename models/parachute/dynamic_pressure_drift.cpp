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
  static constexpr Role ports[] = {{"dynamic_pressure", "Pa"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"pressure_drift", CoefficientKind::strength, 0.0, "Pa/s", -1e4, 1e4, 0.5, "rate of change of the dynamic pressure"},
      {"t_drift", CoefficientKind::shape, 0.0, "s", -1e6, 1e6, 10.0, "time at which the dynamic pressure is the nominal one", Parity::none,
       "", false, true}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    P[0] = in.c[0] * (in.t - in.c[1]);
  }

  static std::vector<Example> examples() {
    return {{{}, {}, {0.5, 10.0}, {}, 90.0, {40.0}, {}, "0.5 Pa/s for 80 s"},
            {{}, {}, {-2.0, 4.0}, {}, 1.0, {6.0}, {}, "by hand: -2 x -3"}};
  }
};

}  // namespace

MISFIT_EFFECT(dynamic_pressure_drift, DynamicPressureDrift)
