#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The flow about the canopy needs time: part of the static moment is the one that belongs to where axis and relative wind were a moment
/// ago. In fixed axes, so that the memory does not turn with the plane of the tilt. Nothing is added in equilibrium: C_m keeps its meaning.
/// Slow motion sees C_m_alpha dalpha_T/dt share tau less of the static moment: damping where the static moment opens the angle further,
/// the opposite of it about a stable trim.
struct AerodynamicLag {
  static constexpr const char* formula =
      "M_y, M_z += share (lambda - M_static), lambda' = (M_static - lambda)/tau; M_static = q S D [C_m(alpha_T)/sin(alpha_T)] (w_y, w_z), "
      "w_y = w_lateral sin(phi)/cos(eta) - w cos(phi), w_z = w_lateral cos(phi)/cos(eta) + w sin(phi)";
  static constexpr const char* symbols =
      "q [Pa], S [m^2], D [m], C_m of the static moment [-], w, w_lateral in-plane and lateral components of (wind direction x axis) [-], "
      "phi clock angle, eta tilt [rad], w_y, w_z the same as a rotation about the fixed axes, lambda lagged moment [N m], share that lags "
      "[-], tau [s]";
  static constexpr const char* valid =
      "one time constant, tilts below 80 deg (a moment along the axis, which does nothing, is left out of the memory)";
  static constexpr const char* size =
      "share = 1, tau = D/V = 45 ms at a slope of C_m of 0.35 per rad: 36 N m s/rad, thrice C_mq = -0.25; it damps where the slope is "
      "unstable, and drives the motion where it is stable";
  static constexpr const char* source =
      "Tobak and Schiff, NASA TR R-456 (1976): indicial response; one exponential of R. T. Jones, NACA 681 (1940)";
  static constexpr const char* excludes = "pure delay, several time constants, lag of the damping";
  static constexpr const char* specialises = "lag";

  enum Quantity { dynamic_pressure, wind_cross_axis, wind_cross_axis_lateral, phi, eta };
  static constexpr Role quantities[] = {{.name = "dynamic_pressure", .unit = "Pa"},
                                        {.name = "wind_cross_axis", .unit = "-"},
                                        {.name = "wind_cross_axis_lateral", .unit = "-"},
                                        {.name = "phi", .unit = "rad"},
                                        {.name = "eta", .unit = "rad"}};
  enum Port { moment_y, moment_z };
  static constexpr Role ports[] = {{.name = "moment_y", .unit = "N m"}, {.name = "moment_z", .unit = "N m"}};
  enum Constant { S, D };
  static constexpr const char* constants[] = {"S", "D"};
  enum Coefficient { share_lag, tau_lag, C_m };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "share_lag", .unit = "-", .lower = -5.0, .upper = 5.0, .scale = 0.2, .doc = "part of the static moment that lags"},
      {.name = "tau_lag",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "s",
       .lower = 1e-3,
       .upper = 100.0,
       .scale = 0.05,
       .doc = "time constant of the flow",
       .scan = {.from = 0.02, .to = 0.5, .count = 5}},
      {.name = "C_m",
       .kind = CoefficientKind::shape,
       .unit = "-",
       .lower = -1e6,
       .upper = 1e6,
       .doc = "static moment coefficient over the sine of alpha_T",
       .shared = true},
  };
  enum State { lambda_y, lambda_z };
  static constexpr OwnStateSpec states[] = {{.name = "lambda_y", .unit = "N m"}, {.name = "lambda_z", .unit = "N m"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    using std::cos;
    using std::sin;
    const T moment = in.q[dynamic_pressure] * (in.k[S] * in.k[D]) * in.c[C_m];
    const T sine = sin(in.q[phi]), cosine = cos(in.q[phi]), across = in.q[wind_cross_axis_lateral] / cos(in.q[eta]);
    const T ahead_y = moment * (across * sine - in.q[wind_cross_axis] * cosine) - in.z[lambda_y];
    const T ahead_z = moment * (across * cosine + in.q[wind_cross_axis] * sine) - in.z[lambda_z];
    F[moment_y] = -in.c[share_lag] * ahead_y;
    F[moment_z] = -in.c[share_lag] * ahead_z;
    drift[lambda_y] = ahead_y / in.c[tau_lag];
    drift[lambda_z] = ahead_z / in.c[tau_lag];
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[tau_lag]; }

  static std::vector<Example> examples() {
    return {{.constants = {2.0, 1.5},
             .quantities = {100.0, 0.3, -0.1, 0.0, 0.0},
             .coefficients = {0.5, 0.2, 0.5},
             .states = {10.0, 20.0},
             .ports = {27.5, 17.5},
             .drifts = {-275.0, -175.0},
             .source = "by hand: 150 N m x (-0.3, -0.1) = (-45, -15) N m, 55 and 35 N m behind the memory"},
            {.constants = {1.9554, 1.5816},
             .quantities = {736.0, 0.17364818, 0.05, 1.0, 0.3},
             .coefficients = {1.0, 0.05, 0.060467094},
             .states = {0.0, 0.0},
             .t = 1.0,
             .ports = {6.8517443, -24.0032876},
             .drifts = {-137.0348851, 480.0657525},
             .source = "137.635092 N m x (0.0440406 - 0.0938225, 0.0282781 + 0.1461199), by a calculator"}};
  }
};

}  // namespace

MISFIT_EFFECT(aerodynamic_lag, AerodynamicLag)
