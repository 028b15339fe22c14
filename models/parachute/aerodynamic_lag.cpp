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

  enum Quantity { dynamic_pressure, n_y, n_z };
  static constexpr Role quantities[] = {
      {.name = "dynamic_pressure", .unit = "Pa"}, {.name = "n_y", .unit = "-"}, {.name = "n_z", .unit = "-"}};
  enum Port { moment_y, moment_z };
  static constexpr Role ports[] = {{.name = "moment_y", .unit = "N m"}, {.name = "moment_z", .unit = "N m"}};
  enum Constant { S, D };
  static constexpr const char* constants[] = {"S", "D"};
  enum Coefficient { C_lag, tau_lag };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "C_lag",
       .unit = "-",
       .lower = -50.0,
       .upper = 50.0,
       .scale = 0.1,
       .doc = "moment coefficient per part of the axis that lags"},
      {.name = "tau_lag",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "s",
       .lower = 1e-3,
       .upper = 100.0,
       .scale = 0.05,
       .doc = "time constant of the flow",
       .scan = {.from = 0.02, .to = 0.5, .count = 5}},
  };
  enum State { lambda_y, lambda_z };
  static constexpr OwnStateSpec states[] = {{.name = "lambda_y", .unit = "-"}, {.name = "lambda_z", .unit = "-"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    const T moment = in.q[dynamic_pressure] * (in.k[S] * in.k[D]) * in.c[C_lag];
    const T ahead_y = in.z[lambda_y] - in.q[n_y], ahead_z = in.z[lambda_z] - in.q[n_z];
    F[moment_y] = -moment * ahead_z;
    F[moment_z] = moment * ahead_y;
    drift[lambda_y] = -ahead_y / in.c[tau_lag];
    drift[lambda_z] = -ahead_z / in.c[tau_lag];
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[tau_lag]; }

  static std::vector<Example> examples() {
    return {{.constants = {2.0, 1.5},
             .quantities = {100.0, 0.1, -0.2},
             .coefficients = {0.5, 0.2},
             .states = {0.3, 0.1},
             .ports = {-45.0, 30.0},
             .drifts = {-1.0, -1.5},
             .source = "by hand: 150 x 0.3, 150 x 0.2"},
            {.constants = {1.9554, 1.5816},
             .quantities = {736.0, -0.2, 0.0},
             .coefficients = {-0.35, 0.05},
             .states = {0.0, 0.0},
             .t = 1.0,
             .ports = {0.0, -159.333876},
             .drifts = {-4.0, 0.0},
             .source = "2276.1982 x -0.35 x 0.2"}};
  }
};

}  // namespace

MISFIT_EFFECT(aerodynamic_lag, AerodynamicLag)
