#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The random moment of unsteady flow: two independent Ornstein-Uhlenbeck processes of unit variance about axes fixed in the tunnel, scaled
/// by the size of the gusts. Its states are random: `filter_error` has such a force always; for deterministic methods, which leave the
/// states at 0, it is silent.
struct Gust {
  static constexpr const char* formula = "M_y = gust_sigma g_y, M_z = gust_sigma g_z, g' = -g/tau + sqrt(2/tau) white noise";
  static constexpr const char* symbols = "gust_sigma standard deviation [N m], gust_tau correlation time [s], g unit processes [-]";
  static constexpr const char* valid = "gusts that do not depend on where the canopy is; the same strength in both axes";
  static constexpr const char* size = "27 N m with 0.1 s: what drives the flights of the data";
  static constexpr const char* source = "Uhlenbeck and Ornstein, Phys. Rev. 36 (1930); Dryden's first-order spectrum of turbulence";
  static constexpr const char* excludes = "lines in the spectrum (vortex_shedding), gusts as wind instead of as moments";

  enum Port { moment_y, moment_z };
  static constexpr Role ports[] = {{.name = "moment_y", .unit = "N m"}, {.name = "moment_z", .unit = "N m"}};
  enum Coefficient { gust_sigma, gust_tau };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "gust_sigma",
       .unit = "N m",
       .lower = 0.0,
       .upper = 1e6,
       .scale = 10.0,
       .doc = "standard deviation of the random moment, per axis"},
      {.name = "gust_tau",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "s",
       .lower = 1e-3,
       .upper = 1e3,
       .scale = 0.05,
       .doc = "correlation time",
       .scan = {.from = 0.03, .to = 1.0, .count = 4}},
  };
  enum State { g_y, g_z };
  static constexpr OwnStateSpec states[] = {{.name = "g_y", .unit = "-"}, {.name = "g_z", .unit = "-"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    F[moment_y] = in.c[gust_sigma] * in.z[g_y];
    F[moment_z] = in.c[gust_sigma] * in.z[g_z];
    drift[g_y] = -in.z[g_y] / in.c[gust_tau];
    drift[g_z] = -in.z[g_z] / in.c[gust_tau];
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[gust_tau]; }

  static void diffusion(const Reads<double, double>& in, double* out) { out[g_y] = out[g_z] = std::sqrt(2.0 / in.c[gust_tau]); }

  static std::vector<Example> examples() {
    return {
        {.coefficients = {27.0, 0.1}, .states = {1.0, -0.5}, .ports = {27.0, -13.5}, .drifts = {-10.0, 5.0}, .source = "by hand"},
        {.coefficients = {10.0, 0.5}, .states = {-0.3, 2.0}, .t = 4.0, .ports = {-3.0, 20.0}, .drifts = {0.6, -4.0}, .source = "by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(gust, Gust)
