#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Vortices shed by the strut or the backshell shake the canopy at one frequency, in axes fixed in the tunnel. The Strouhal number f d/V
/// tells by what: about 0.2 for a round strut of diameter d, so d = 0.2 V/f.
struct VortexShedding {
  static constexpr const char* formula =
      "M_y = q S D [y_cosine cos(2 pi f t) + y_sine sin(2 pi f t)], M_z the same with z_cosine, z_sine; Strouhal number f d/V";
  static constexpr const char* symbols =
      "moment coefficients about the fixed axes y and z [-], f frequency [Hz], t time of the recording [s]";
  static constexpr const char* valid = "a frequency that stays within 1/(2T) over a recording of length T; a line, not a band";
  static constexpr const char* size = "0.012: 27 N m at 736 Pa for D = 1.58 m; at resonance more than the random moment moves the canopy";
  static constexpr const char* source = "Roshko, NACA Report 1191 (1954): Strouhal number 0.2 for a cylinder";
  static constexpr const char* excludes = "bandwidth and drift of the frequency, harmonics, dependence on where the canopy is";
  static constexpr const char* specialises = "periodic_forcing";
  static constexpr Role quantities[] = {{"dynamic_pressure", "Pa"}};
  static constexpr Role ports[] = {{"moment_y", "N m"}, {"moment_z", "N m"}};
  static constexpr const char* constants[] = {"S", "D"};
  static constexpr CoefficientSpec coefficients[] = {
      {"y_cosine", CoefficientKind::strength, 0.0, "-", -10.0, 10.0, 0.005, "moment coefficient about y in phase with cos(2 pi f t)"},
      {"y_sine", CoefficientKind::strength, 0.0, "-", -10.0, 10.0, 0.005, "about y in phase with sin(2 pi f t)"},
      {"z_cosine", CoefficientKind::strength, 0.0, "-", -10.0, 10.0, 0.005, "about z in phase with cos(2 pi f t)"},
      {"z_sine", CoefficientKind::strength, 0.0, "-", -10.0, 10.0, 0.005, "about z in phase with sin(2 pi f t)"},
      {"shedding_frequency",
       CoefficientKind::shape,
       2.0,
       "Hz",
       1e-3,
       100.0,
       0.05,
       "frequency of the vortices",
       Parity::none,
       "",
       false,
       false,
       {0.2, 12.0, -1}}};

  static constexpr double two_pi = 6.28318530717958647692;

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::cos;
    using std::sin;
    const T angle = two_pi * in.t * in.c[4];
    const T moment = in.q[0] * (in.k[0] * in.k[1]);
    const T cosine = moment * cos(angle), sine = moment * sin(angle);
    F[0] = in.c[0] * cosine + in.c[1] * sine;
    F[1] = in.c[2] * cosine + in.c[3] * sine;
  }

  static double fastest_rate(const Reads<double, double>& in) { return two_pi * in.c[4]; }

  static std::vector<Example> examples() {
    return {
        {{1.9554, 1.5816}, {736.0}, {0.012, 0.0, 0.02, 0.0, 2.5}, {}, 0.4, {27.314378, 45.523964}, {}, "a whole turn: the cosines alone"},
        {{2.0, 1.5},
         {100.0},
         {0.1, 0.2, -0.3, 0.4, 1.0},
         {},
         1.0 / 3.0,
         {36.9615242, 148.923048},
         {},
         "120 deg: 300 x (-0.05 + 0.2 x 0.866025404) and 300 x (0.15 + 0.4 x 0.866025404)"}};
  }
};

}  // namespace

MISFIT_EFFECT(vortex_shedding, VortexShedding)
