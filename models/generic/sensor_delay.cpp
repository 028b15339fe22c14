#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A reading that comes late while the others do not: a slow bus, a video line. Second-order Pade approximation as in `delay`; time_offset
/// moves all readings together and is exact.
struct SensorDelay {
  static constexpr const char* formula =
      "y = h + late_share (h(t - tau) - h), h(t - tau) = h - tau z_rate; z' = z_rate, z_rate' = 12/tau^2 (h - z) - 6/tau z_rate";
  static constexpr const char* symbols =
      "h predicted reading, z, z_rate filtered reading and its rate, late_share of the reading [-] (1: all of it), tau = sensor_delay [s]";
  static constexpr const char* valid = "readings slower than 1.7/tau (phase to 1 %)";
  static constexpr const char* size = "20 ms at 1 rad/s: 2 % of the amplitude, 90 deg after it";
  static constexpr const char* source = "Golub and Van Loan, Matrix Computations, 11.3: Pade (2, 2) of exp(-tau s)";
  static constexpr const char* excludes = "a clock that is off for all channels (time_offset), delays that change";
  static constexpr Role quantities[] = {{"reading", "*"}};
  static constexpr Role ports[] = {{"output", "{reading}"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"late_share", CoefficientKind::strength, 0.0, "-", -2.0, 2.0, 0.1, "part of the reading that comes late"},
      scanned({"sensor_delay", CoefficientKind::shape, 0.05, "s", 1e-6, 1e6, 0.05, "delay"}, {1.0, 20.0, 4, "step"})};
  static constexpr OwnStateSpec states[] = {{"z", "{output}", 0.0}, {"z_rate", "{output}/s", 0.0}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y, T* drift) {
    const T& tau = in.c[1];
    y[0] = -in.c[0] * tau * in.z[1];
    drift[0] = in.z[1];
    drift[1] = (12.0 * (in.q[0] - in.z[0]) / tau - 6.0 * in.z[1]) / tau;
  }

  /// Its poles lie at |s| = sqrt(12)/tau.
  static double fastest_rate(const Reads<double, double>& in) { return 3.4641 / in.c[1]; }

  static std::vector<Example> examples() {
    return {{{}, {3.0}, {2.0, 0.5}, {2.0, 1.5}, 0.0, {-1.5}, {1.5, 30.0}, "-2 x 0.5 x 1.5; 12 x 1/0.25 - 6 x 1.5/0.5"},
            {{}, {1.0}, {-1.0, 2.0}, {4.0, -0.25}, 1.0, {-0.5}, {-0.25, -8.25}, "by hand: 12 x -3/4 + 6 x 0.25/2"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_delay, SensorDelay)
