#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Vortices whose frequency drifts: not the steady line that is offered (vortex_shedding).
struct DriftingVortices {
  static constexpr const char* formula = "M_y = q S D [drift_y cos(a) + drift_z sin(a)], M_z the same turned, a = 2 pi (f0 t + f1 t^2/2)";
  static constexpr const char* symbols = "drift_y, drift_z [-], f0 drift_from [Hz], f1 drift_rate [Hz/s], t [s]";
  static constexpr const char* valid = "simulation";
  static constexpr const char* size = "as vortex_shedding";
  static constexpr const char* source = "made up for the bench";
  static constexpr const char* excludes = "everything else";

  enum Quantity { dynamic_pressure };
  static constexpr Role quantities[] = {{.name = "dynamic_pressure", .unit = "Pa"}};
  enum Port { moment_y, moment_z };
  static constexpr Role ports[] = {{.name = "moment_y", .unit = "N m"}, {.name = "moment_z", .unit = "N m"}};
  enum Constant { S, D };
  static constexpr const char* constants[] = {"S", "D"};
  enum Coefficient { drift_y, drift_z, drift_from, drift_rate };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "drift_y", .unit = "-", .lower = -10.0, .upper = 10.0, .scale = 0.005, .doc = "moment coefficient about y"},
      {.name = "drift_z", .unit = "-", .lower = -10.0, .upper = 10.0, .scale = 0.005, .doc = "moment coefficient about z"},
      {.name = "drift_from",
       .kind = CoefficientKind::shape,
       .value = 2.0,
       .unit = "Hz",
       .lower = 1e-3,
       .upper = 100.0,
       .scale = 0.05,
       .doc = "frequency at t = 0"},
      {.name = "drift_rate",
       .kind = CoefficientKind::shape,
       .value = 0.0,
       .unit = "1/s^2",
       .lower = -1.0,
       .upper = 1.0,
       .scale = 1e-3,
       .doc = "change of the frequency"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::cos;
    using std::sin;
    constexpr double two_pi = 6.28318530717958647692;
    const T angle = two_pi * in.t * (in.c[drift_from] + 0.5 * in.t * in.c[drift_rate]);
    const T moment = in.q[dynamic_pressure] * (in.k[S] * in.k[D]);
    F[moment_y] = moment * (in.c[drift_y] * cos(angle) + in.c[drift_z] * sin(angle));
    F[moment_z] = moment * (in.c[drift_z] * cos(angle) - in.c[drift_y] * sin(angle));
  }

  static double fastest_rate(const Reads<double, double>& in) { return 6.28318530717958647692 * in.c[drift_from]; }

  static std::vector<Example> examples() {
    return {{.constants = {2.0, 1.5},
             .quantities = {100.0},
             .coefficients = {0.1, 0.2, 0.125, 0.125},
             .t = 1.0,
             .ports = {105.066017, 17.573593},
             .source = "3/16 of a turn: 67.5 deg"}};
  }
};

}  // namespace

MISFIT_EFFECT(drifting_vortices, DriftingVortices)
