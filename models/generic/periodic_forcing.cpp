#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A force at one frequency, of any phase: a line in the spectrum of the missing force.
struct PeriodicForcing {
  static constexpr const char* formula = "F = cosine cos(2 pi f t) + sine sin(2 pi f t)";
  static constexpr const char* symbols = "cosine, sine amplitudes [port], f frequency [Hz], t time of the recording [s]";
  static constexpr const char* valid = "a frequency that stays within 1/(2T) over a recording of length T";
  static constexpr const char* size = "amplitude sqrt(cosine^2 + sine^2); a vortex street behind the strut: some N m";
  static constexpr const char* source = "Fourier; amplitudes instead of amplitude and phase keep off at a regular point";
  static constexpr const char* excludes = "drift of the frequency, bandwidth, harmonics";
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"cosine", CoefficientKind::strength, 0.0, "{port}", -1e6, 1e6, 1.0, "amplitude in phase with cos(2 pi f t)"},
      {"sine", CoefficientKind::strength, 0.0, "{port}", -1e6, 1e6, 1.0, "amplitude in phase with sin(2 pi f t)"},
      scanned({"frequency", CoefficientKind::shape, 1.0, "Hz", 1e-6, 1e3, 0.1, "frequency of the forcing"}, {1e-6, 1e3, -1})};

  static constexpr double two_pi = 6.28318530717958647692;

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::cos;
    using std::sin;
    const T angle = two_pi * in.t * in.c[2];
    F[0] = in.c[0] * cos(angle) + in.c[1] * sin(angle);
  }

  static double fastest_rate(const Reads<double, double>& in) { return two_pi * in.c[2]; }

  static std::vector<Example> examples() {
    return {{{}, {}, {3.0, 5.0, 2.0}, {}, 0.125, {5.0}, {}, "a quarter of a period of 2 Hz: the sine alone"},
            {{}, {}, {3.0, 5.0, 0.5}, {}, 1.0 / 3.0, {5.83012702}, {}, "60 deg: 3/2 + 5 x 0.866025404"}};
  }
};

}  // namespace

MISFIT_EFFECT(periodic_forcing, PeriodicForcing)
