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
  static constexpr const char* size = "about 1 px near 9 Hz: more than the measurement noise, 0.05 deg";
  static constexpr const char* source =
      "Schoenenberger, Queen, Cruz, Parachute Aerodynamics from Video Data, AIAA 2005-1633 (2005), Parachute Attitude Measurements: motion "
      "of the disk relative to the band; var e = D^2/(4 zeta w^3) = 1 (Lyapunov equation)";
  static constexpr const char* excludes = "the moment of the ring on the canopy";

  enum Port { P_y, P_z };
  static constexpr Role ports[] = {{.name = "P_y", .unit = "px"}, {.name = "P_z", .unit = "px"}};
  enum Coefficient { jitter, jitter_frequency, jitter_damping };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "jitter", .unit = "px", .lower = 0.0, .upper = 1e3, .scale = 1.0, .doc = "standard deviation of the jitter"},
      {.name = "jitter_frequency",
       .kind = CoefficientKind::shape,
       .value = 9.0,
       .unit = "Hz",
       .lower = 0.01,
       .upper = 1e3,
       .scale = 1.0,
       .doc = "frequency of the resonator",
       .scan = {.from = 3.0, .to = 27.0, .count = 9}},
      {.name = "jitter_damping",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "-",
       .lower = 0.001,
       .upper = 5.0,
       .scale = 0.05,
       .doc = "damping ratio of the resonator"},
  };
  enum State { e_y, e_y_rate, e_z, e_z_rate };
  static constexpr OwnStateSpec states[] = {
      {.name = "e_y", .unit = "-"}, {.name = "e_y_rate", .unit = "1/s"}, {.name = "e_z", .unit = "-"}, {.name = "e_z_rate", .unit = "1/s"}};

  static constexpr double two_pi = 6.28318530717958647692;

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P, T* drift) {
    const T omega = two_pi * in.c[jitter_frequency];
    P[P_y] = in.c[jitter] * in.z[e_y];
    P[P_z] = in.c[jitter] * in.z[e_z];
    drift[e_y] = in.z[e_y_rate];
    drift[e_z] = in.z[e_z_rate];
    drift[e_y_rate] = -omega * (omega * in.z[e_y] + 2.0 * in.c[jitter_damping] * in.z[e_y_rate]);
    drift[e_z_rate] = -omega * (omega * in.z[e_z] + 2.0 * in.c[jitter_damping] * in.z[e_z_rate]);
  }

  static double fastest_rate(const Reads<double, double>& in) { return two_pi * in.c[jitter_frequency]; }

  static void diffusion(const Reads<double, double>& in, double* out) {
    const double omega = two_pi * in.c[jitter_frequency];
    out[e_y] = out[e_z] = 0.0;
    out[e_y_rate] = out[e_z_rate] = 2.0 * std::sqrt(in.c[jitter_damping] * omega * omega * omega);
  }

  static std::vector<Example> examples() {
    // f = 1/(2 pi) Hz: w = 1.
    return {{.coefficients = {2.0, 0.15915494, 0.1},
             .states = {0.5, 3.0, -1.0, 2.0},
             .ports = {1.0, -2.0},
             .drifts = {3.0, -1.1, 2.0, 0.6},
             .source = "by hand at w = 1/s"},
            {.coefficients = {1.0, 9.0, 0.2},
             .states = {1.0, 0.0, 0.0, 10.0},
             .ports = {1.0, 0.0},
             .drifts = {0.0, -3197.75183, 10.0, -226.194671},
             .source = "w = 56.5486678/s"}};
  }
};

}  // namespace

MISFIT_EFFECT(apex_jitter, ApexJitter)
