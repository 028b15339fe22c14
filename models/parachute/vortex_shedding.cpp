#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Vortices shed by the strut or the backshell shake the canopy at one frequency, in axes fixed in the tunnel. The Strouhal number f d/V
/// is about 0.2 for a round strut of diameter d: d = 0.2 V/f identifies the strut.
struct VortexShedding {
  static constexpr const char* formula =
      "M_y = q S D [y_cosine cos(2 pi n) + y_sine sin(2 pi n)], n = f t + f' t^2/2, M_z the same with z_cosine, z_sine; Strouhal number "
      "f d/V";
  static constexpr const char* symbols =
      "moment coefficients about the fixed axes y and z [-], f frequency at t = 0 [Hz], f' its drift [Hz/s], n periods since t = 0, t time "
      "of "
      "the recording [s]";
  static constexpr const char* valid =
      "a frequency that stays, or drifts evenly, to within 1/(2T) over a recording of length T; a line, not a band";
  static constexpr const char* size = "0.012: 27 N m at 736 Pa for D = 1.58 m; at resonance more than the random moment moves the canopy";
  static constexpr const char* source = "Roshko, NACA Report 1191 (1954): Strouhal number 0.2 for a cylinder";
  static constexpr const char* excludes = "bandwidth and uneven drift of the frequency, harmonics, dependence on where the canopy is";
  static constexpr const char* specialises = "periodic_forcing";

  enum Quantity { dynamic_pressure };
  static constexpr Role quantities[] = {{.name = "dynamic_pressure", .unit = "Pa"}};
  enum Port { moment_y, moment_z };
  static constexpr Role ports[] = {{.name = "moment_y", .unit = "N m"}, {.name = "moment_z", .unit = "N m"}};
  enum Constant { S, D };
  static constexpr const char* constants[] = {"S", "D"};
  enum Coefficient { y_cosine, y_sine, z_cosine, z_sine, shedding_frequency, shedding_drift };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "y_cosine",
       .unit = "-",
       .lower = -10.0,
       .upper = 10.0,
       .scale = 0.005,
       .doc = "moment coefficient about y in phase with cos(2 pi f t)"},
      {.name = "y_sine", .unit = "-", .lower = -10.0, .upper = 10.0, .scale = 0.005, .doc = "about y in phase with sin(2 pi f t)"},
      {.name = "z_cosine", .unit = "-", .lower = -10.0, .upper = 10.0, .scale = 0.005, .doc = "about z in phase with cos(2 pi f t)"},
      {.name = "z_sine", .unit = "-", .lower = -10.0, .upper = 10.0, .scale = 0.005, .doc = "about z in phase with sin(2 pi f t)"},
      {.name = "shedding_frequency",
       .kind = CoefficientKind::shape,
       .value = 2.0,
       .unit = "Hz",
       .lower = 1e-3,
       .upper = 100.0,
       .scale = 0.05,
       .doc = "frequency of the vortices",
       .scan = {.from = 0.2, .to = 12.0, .count = -1}},
      {.name = "shedding_drift",
       .kind = CoefficientKind::shape,
       .unit = "Hz/s",
       .lower = -1.0,
       .upper = 1.0,
       .scale = 1e-3,
       .doc = "change of that frequency with time, as of a wind speed that is not held",
       .fixed = true,
       .drift_of = "shedding_frequency"},
  };

  static constexpr double two_pi = 6.28318530717958647692;

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::cos;
    using std::sin;
    const T angle = two_pi * in.t * (in.c[shedding_frequency] + 0.5 * in.t * in.c[shedding_drift]);
    const T moment = in.q[dynamic_pressure] * (in.k[S] * in.k[D]);
    const T cosine = moment * cos(angle), sine = moment * sin(angle);
    F[moment_y] = in.c[y_cosine] * cosine + in.c[y_sine] * sine;
    F[moment_z] = in.c[z_cosine] * cosine + in.c[z_sine] * sine;
  }

  static double fastest_rate(const Reads<double, double>& in) {
    return two_pi * std::abs(in.c[shedding_frequency] + in.t * in.c[shedding_drift]);
  }

  static std::vector<Example> examples() {
    return {{.constants = {1.9554, 1.5816},
             .quantities = {736.0},
             .coefficients = {0.012, 0.0, 0.02, 0.0, 2.5, 0.0},
             .t = 0.4,
             .ports = {27.314378, 45.523964},
             .source = "a whole turn: the cosines alone"},
            {.constants = {2.0, 1.5},
             .quantities = {100.0},
             .coefficients = {0.1, 0.2, -0.3, 0.4, 0.5, 3.0},
             .t = 1.0 / 3.0,
             .ports = {36.9615242, 148.923048},
             .source = "1/6 + 3/18 = 1/3 periods, 120 deg: 300 x (-0.05 + 0.2 x 0.866025404) and 300 x (0.15 + 0.4 x 0.866025404)"}};
  }
};

}  // namespace

MISFIT_EFFECT(vortex_shedding, VortexShedding)
