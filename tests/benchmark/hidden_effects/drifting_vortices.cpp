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
  static constexpr Role quantities[] = {{"dynamic_pressure", "Pa"}};
  static constexpr Role ports[] = {{"moment_y", "N m"}, {"moment_z", "N m"}};
  static constexpr const char* constants[] = {"S", "D"};
  static constexpr CoefficientSpec coefficients[] = {
      {"drift_y", CoefficientKind::strength, 0.0, "-", -10.0, 10.0, 0.005, "moment coefficient about y"},
      {"drift_z", CoefficientKind::strength, 0.0, "-", -10.0, 10.0, 0.005, "moment coefficient about z"},
      {"drift_from", CoefficientKind::shape, 2.0, "Hz", 1e-3, 100.0, 0.05, "frequency at t = 0"},
      {"drift_rate", CoefficientKind::shape, 0.0, "1/s^2", -1.0, 1.0, 1e-3, "change of the frequency"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::cos;
    using std::sin;
    constexpr double two_pi = 6.28318530717958647692;
    const T angle = two_pi * in.t * (in.c[2] + 0.5 * in.t * in.c[3]);
    const T moment = in.q[0] * (in.k[0] * in.k[1]);
    F[0] = moment * (in.c[0] * cos(angle) + in.c[1] * sin(angle));
    F[1] = moment * (in.c[1] * cos(angle) - in.c[0] * sin(angle));
  }

  static double fastest_rate(const Reads<double, double>& in) { return 6.28318530717958647692 * in.c[2]; }

  static std::vector<Example> examples() {
    return {{{2.0, 1.5}, {100.0}, {0.1, 0.2, 0.125, 0.125}, {}, 1.0, {105.066017, 17.573593}, {}, "3/16 of a turn: 67.5 deg"}};
  }
};

}  // namespace

MISFIT_EFFECT(drifting_vortices, DriftingVortices)
