#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The flow about the canopy needs time: part of the moment answers to where the canopy was a moment ago. In fixed axes, so that the memory
/// does not turn with the plane of the tilt: each part of the axis n has its lagged lambda, and the moment pushes towards what lambda lags
/// behind. Nothing is added in equilibrium: C_m keeps its meaning.
struct AerodynamicLag {
  static constexpr const char* formula =
      "force along y, z of q S D C_lag (lambda - n) as moments M_z = q S D C_lag (lambda_y - n_y), M_y = -q S D C_lag (lambda_z - n_z); "
      "lambda' = (n - lambda)/tau";
  static constexpr const char* symbols = "n_y, n_z parts of the axis, lambda lagged [-], C_lag [-] per unit of n (per rad), tau_lag [s]";
  static constexpr const char* valid = "small tilts, one time constant; slow motion (tau omega << 1) sees damping q S D C_lag tau";
  static constexpr const char* size =
      "C_lag = 0.35 per rad (the slope of C_m at the trim) with tau = D/V = 45 ms: 36 N m s/rad, thrice C_mq = -0.25";
  static constexpr const char* source =
      "Tobak and Schiff, NASA TR R-456 (1976); Theodorsen's lag as one exponential (R. T. Jones, NACA 681)";
  static constexpr const char* excludes = "pure delay, several time constants, lag of the damping";
  static constexpr const char* specialises = "lag";
  static constexpr Role quantities[] = {{"dynamic_pressure", "Pa"}, {"n_y", "-"}, {"n_z", "-"}};
  static constexpr Role ports[] = {{"moment_y", "N m"}, {"moment_z", "N m"}};
  static constexpr const char* constants[] = {"S", "D"};
  static constexpr CoefficientSpec coefficients[] = {
      {"C_lag", CoefficientKind::strength, 0.0, "-", -50.0, 50.0, 0.1, "moment coefficient per part of the axis that lags"},
      {"tau_lag",
       CoefficientKind::shape,
       0.1,
       "s",
       1e-3,
       100.0,
       0.05,
       "time constant of the flow",
       Parity::none,
       "",
       false,
       false,
       {0.02, 0.5, 5}}};
  static constexpr OwnStateSpec states[] = {{"lambda_y", "-", 0.0}, {"lambda_z", "-", 0.0}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    const T moment = in.q[0] * (in.k[0] * in.k[1]) * in.c[0];
    const T ahead_y = in.z[0] - in.q[1], ahead_z = in.z[1] - in.q[2];
    F[0] = -moment * ahead_z;
    F[1] = moment * ahead_y;
    drift[0] = -ahead_y / in.c[1];
    drift[1] = -ahead_z / in.c[1];
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[1]; }

  static std::vector<Example> examples() {
    return {
        {{2.0, 1.5}, {100.0, 0.1, -0.2}, {0.5, 0.2}, {0.3, 0.1}, 0.0, {-45.0, 30.0}, {-1.0, -1.5}, "by hand: 150 x 0.3, 150 x 0.2"},
        {{1.9554, 1.5816}, {736.0, -0.2, 0.0}, {-0.35, 0.05}, {0.0, 0.0}, 1.0, {0.0, -159.333876}, {-4.0, 0.0}, "2276.1982 x -0.35 x 0.2"}};
  }
};

}  // namespace

MISFIT_EFFECT(aerodynamic_lag, AerodynamicLag)
