#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A force at one frequency, of any phase: a line in the spectrum of the missing force. Or a parameter that goes up and down: a growth rate
/// by day and night, the stiffness of a pair of gears as their teeth come into contact.
struct PeriodicForcing {
  static constexpr const char* formula = "F = cosine cos(2 pi n) + sine sin(2 pi n), n = f t + f' t^2/2";
  static constexpr const char* symbols =
      "cosine, sine amplitudes [port], a force or a parameter, f frequency at t = 0 [Hz], f' its drift [Hz/s], n periods since t = 0, t "
      "time of the recording [s]";
  static constexpr const char* valid = "a frequency that stays, or drifts evenly, to within 1/(2T) over a recording of length T";
  static constexpr const char* size = "amplitude sqrt(cosine^2 + sine^2); a vortex street behind the strut: some N m";
  static constexpr const char* source = "Fourier; amplitudes instead of amplitude and phase keep off at a regular point";
  static constexpr const char* excludes = "uneven drift of the frequency, bandwidth, harmonics";

  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*", .parameter_too = true}};
  enum Coefficient { cosine, sine, frequency, frequency_drift };
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
      {.name = "frequency_drift",
       .kind = CoefficientKind::shape,
       .unit = "Hz/s",
       .lower = -1e6,
       .upper = 1e6,
       .scale = 1e-3,
       .doc = "change of the frequency with time",
       .fixed = true,
       .drift_of = "frequency"},
  };

  static constexpr double two_pi = 6.28318530717958647692;

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = wave(T(in.t * (in.c[frequency] + 0.5 * in.t * in.c[frequency_drift])), in.c[cosine], in.c[sine]);
  }

  static double fastest_rate(const Reads<double, double>& in) { return two_pi * std::abs(in.c[frequency] + in.t * in.c[frequency_drift]); }

  static std::vector<Example> examples() {
    return {{.coefficients = {3.0, 5.0, 2.0, 0.0}, .t = 0.125, .ports = {5.0}, .source = "a quarter of a period of 2 Hz: the sine alone"},
            {.coefficients = {3.0, 5.0, 0.5, 0.0}, .t = 1.0 / 3.0, .ports = {5.83012702}, .source = "60 deg: 3/2 + 5 x 0.866025404"},
            {.coefficients = {3.0, 5.0, 1.0, 0.5}, .t = 2.0, .ports = {3.0}, .source = "2 + 0.5 x 4/2 = 3 whole periods: the cosine alone"},
            {.coefficients = {3.0, 5.0, 0.5, 0.125}, .t = 2.0, .ports = {5.0}, .source = "1 + 0.25 periods: the sine alone"}};
  }
};

}  // namespace

MISFIT_EFFECT(periodic_forcing, PeriodicForcing)
