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

  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { cosine, sine, frequency };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "cosine", .unit = "{port}", .lower = -1e15, .upper = 1e15, .scale = 1.0, .doc = "amplitude in phase with cos(2 pi f t)"},
      {.name = "sine", .unit = "{port}", .lower = -1e15, .upper = 1e15, .scale = 1.0, .doc = "amplitude in phase with sin(2 pi f t)"},
      {.name = "frequency",
       .kind = CoefficientKind::shape,
       .value = 1.0,
       .unit = "Hz",
       .lower = 1e-9,
       .upper = 1e9,
       .scale = 0.1,
       .doc = "frequency of the forcing",
       .scan = {.from = 1e-6, .to = 1e3, .count = -1}},
  };

  static constexpr double two_pi = 6.28318530717958647692;

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::cos;
    using std::sin;
    const T angle = two_pi * in.t * in.c[frequency];
    F[port] = in.c[cosine] * cos(angle) + in.c[sine] * sin(angle);
  }

  static double fastest_rate(const Reads<double, double>& in) { return two_pi * in.c[frequency]; }

  static std::vector<Example> examples() {
    return {{.coefficients = {3.0, 5.0, 2.0}, .t = 0.125, .ports = {5.0}, .source = "a quarter of a period of 2 Hz: the sine alone"},
            {.coefficients = {3.0, 5.0, 0.5}, .t = 1.0 / 3.0, .ports = {5.83012702}, .source = "60 deg: 3/2 + 5 x 0.866025404"}};
  }
};

}  // namespace

MISFIT_EFFECT(periodic_forcing, PeriodicForcing)
