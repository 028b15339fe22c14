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
  static constexpr Role ports[] = {{"moment_y", "N m"}, {"moment_z", "N m"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"gust_sigma", CoefficientKind::strength, 0.0, "N m", 0.0, 1e6, 10.0, "standard deviation of the random moment, per axis"},
      {"gust_tau", CoefficientKind::shape, 0.1, "s", 1e-3, 1e3, 0.05, "correlation time", Parity::none, "", false, false, {0.03, 1.0, 4}}};
  static constexpr OwnStateSpec states[] = {{"g_y", "-", 0.0}, {"g_z", "-", 0.0}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    for (int axis = 0; axis < 2; ++axis) {
      F[axis] = in.c[0] * in.z[axis];
      drift[axis] = -in.z[axis] / in.c[1];
    }
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[1]; }

  static void diffusion(const Reads<double, double>& in, double* out) { out[0] = out[1] = std::sqrt(2.0 / in.c[1]); }

  static std::vector<Example> examples() {
    return {{{}, {}, {27.0, 0.1}, {1.0, -0.5}, 0.0, {27.0, -13.5}, {-10.0, 5.0}, "by hand"},
            {{}, {}, {10.0, 0.5}, {-0.3, 2.0}, 4.0, {-3.0, 20.0}, {0.6, -4.0}, "by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(gust, Gust)
