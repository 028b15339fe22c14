#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The apex ring moves against the canopy: what is seen is not quite the axis. A noisy resonator of unit variance per image axis, scaled by
/// the size of the jitter; sampled, each is an AR(2) process. Its states are random: a deterministic method, which leaves them at 0, sees
/// nothing of it.
struct ApexJitter {
  static constexpr const char* formula =
      "P = P0 + jitter (e_y, e_z), e' = v, v' = -w^2 e - 2 zeta w v + 2 sqrt(zeta w^3) white noise, w = 2 pi f (each axis)";
  static constexpr const char* symbols = "jitter standard deviation [px], f jitter_frequency [Hz], zeta jitter_damping [-]";
  static constexpr const char* valid = "f below half the sampling rate; the same in both axes";
  static constexpr const char* size = "about 1 px near 9 Hz: more than the reading noise, a tenth of a degree";
  static constexpr const char* source =
      "paper, Parachute Attitude Measurements: motion of the disk relative to the band; var e = D^2/(4 zeta w^3) = 1 (Lyapunov equation)";
  static constexpr const char* excludes = "the moment of the ring on the canopy";
  static constexpr Role ports[] = {{"P_y", "px"}, {"P_z", "px"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"jitter", CoefficientKind::strength, 0.0, "px", 0.0, 1e3, 1.0, "standard deviation of the jitter"},
      {"jitter_frequency",
       CoefficientKind::shape,
       9.0,
       "Hz",
       0.01,
       1e3,
       1.0,
       "frequency of the resonator",
       Parity::none,
       "",
       false,
       false,
       {3.0, 27.0, 9}},
      {"jitter_damping", CoefficientKind::shape, 0.1, "-", 0.001, 5.0, 0.05, "damping ratio of the resonator"}};
  static constexpr OwnStateSpec states[] = {{"e_y", "-", 0.0}, {"e_y_rate", "1/s", 0.0}, {"e_z", "-", 0.0}, {"e_z_rate", "1/s", 0.0}};

  static constexpr double two_pi = 6.28318530717958647692;

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P, T* drift) {
    const T omega = two_pi * in.c[1];
    for (int axis = 0; axis < 2; ++axis) {
      const std::ptrdiff_t first = 2 * static_cast<std::ptrdiff_t>(axis);
      const T &e = in.z[first], &v = in.z[first + 1];
      P[axis] = in.c[0] * e;
      drift[first] = v;
      drift[first + 1] = -omega * (omega * e + 2.0 * in.c[2] * v);
    }
  }

  static double fastest_rate(const Reads<double, double>& in) { return two_pi * in.c[1]; }

  static void diffusion(const Reads<double, double>& in, double* out) {
    const double omega = two_pi * in.c[1];
    out[0] = out[2] = 0.0;
    out[1] = out[3] = 2.0 * std::sqrt(in.c[2] * omega * omega * omega);
  }

  static std::vector<Example> examples() {
    // f = 1/(2 pi) Hz: w = 1.
    return {{{}, {}, {2.0, 0.15915494, 0.1}, {0.5, 3.0, -1.0, 2.0}, 0.0, {1.0, -2.0}, {3.0, -1.1, 2.0, 0.6}, "by hand at w = 1/s"},
            {{}, {}, {1.0, 9.0, 0.2}, {1.0, 0.0, 0.0, 10.0}, 0.0, {1.0, 0.0}, {0.0, -3197.75183, 10.0, -226.194671}, "w = 56.5486678/s"}};
  }
};

}  // namespace

MISFIT_EFFECT(apex_jitter, ApexJitter)
