#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The wake of the strut that holds the backshell: in a sector of clock angles the canopy's static moment is weaker, and a moment across
/// the plane of the tilt pushes it out of the sector. The window w is a Gaussian of the chord 2 sin(Delta/2) instead of the angle itself,
/// so that it is smooth all the way round (von Mises); it differs from the Gaussian of Delta by less than 1.5 % of its height for widths
/// below 0.4 rad. The last factor closes the window where the clock angle means nothing: below 1 deg of tilt the canopy covers all sectors
/// alike.
struct StrutWake {
  static constexpr const char* formula =
      "M_in-plane = -depth w q S D C_m(alpha_T), M_lateral = q S D sin(eta) push w sin(Delta)/width, w = exp(-(1 - cos Delta)/width^2) "
      "sin^4(eta)/(sin^4(eta) + 0.02^4), Delta = phi - wake_phi";
  static constexpr const char* symbols =
      "C_m of the static moment [-], along the relative wind as that is; phi clock angle, wake_phi, width [rad]; eta tilt; depth, push [-]";
  static constexpr const char* valid = "quasi-steady; one strut; the wake reaches as far out as the tilts that are visited";
  static constexpr const char* size = "push = 0.15 at eta = 12 deg and one width from the centre: 43 N m, more than the random moment";
  static constexpr const char* source =
      "paper, Parachute Attitude Measurements: the parachute tends not to travel through the wake of the strut; the form is ours";
  static constexpr const char* excludes = "unsteadiness of the wake (vortex_shedding), its end in radius, weaker damping inside it";

  enum Quantity { dynamic_pressure, wind_cross_axis, wind_cross_axis_lateral, phi, eta };
  static constexpr Role quantities[] = {{.name = "dynamic_pressure", .unit = "Pa"},
                                        {.name = "wind_cross_axis", .unit = "-"},
                                        {.name = "wind_cross_axis_lateral", .unit = "-"},
                                        {.name = "phi", .unit = "rad"},
                                        {.name = "eta", .unit = "rad"}};
  enum Port { pitching_moment, lateral_moment };
  static constexpr Role ports[] = {{.name = "pitching_moment", .unit = "N m"}, {.name = "lateral_moment", .unit = "N m"}};
  enum Constant { S, D };
  static constexpr const char* constants[] = {"S", "D"};
  enum Coefficient { wake_depth, wake_push, wake_phi, wake_width, C_m };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "wake_depth",
       .unit = "-",
       .lower = -1.0,
       .upper = 1.0,
       .scale = 0.3,
       .doc = "part of the static moment that the wake takes away"},
      {.name = "wake_push",
       .unit = "-",
       .lower = -2.0,
       .upper = 2.0,
       .scale = 0.1,
       .doc = "sideways moment coefficient; positive: away from the wake"},
      {.name = "wake_phi",
       .kind = CoefficientKind::shape,
       .value = 0.0,
       .unit = "rad",
       .lower = -6.3,
       .upper = 6.3,
       .scale = 0.2,
       .doc = "clock angle of the strut",
       .scan = {.from = -3.0543262, .to = 3.0543262, .count = 36}},
      {.name = "wake_width",
       .kind = CoefficientKind::shape,
       .value = 0.4,
       .unit = "rad",
       .lower = 0.05,
       .upper = 1.6,
       .scale = 0.1,
       .doc = "half width: where the window has 61 % of its height",
       .scan = {.from = 0.2, .to = 0.6, .count = 3}},
      {.name = "C_m",
       .kind = CoefficientKind::shape,
       .unit = "-",
       .lower = -1e6,
       .upper = 1e6,
       .doc = "static moment coefficient over the sine of alpha_T",
       .shared = true},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::cos;
    using std::exp;
    using std::sin;
    constexpr double covered = 0.02;  // sine of the tilt below which the canopy, 0.8 m wide 3 m downstream, covers all sectors
    const T sine = sin(in.q[eta]);
    const T delta = in.q[phi] - in.c[wake_phi];
    const T fourth = sine * sine * sine * sine;
    const T open = fourth / (fourth + covered * covered * covered * covered);
    const T window = open * exp(T((cos(delta) - 1.0) / (in.c[wake_width] * in.c[wake_width])));
    const T moment = in.q[dynamic_pressure] * (in.k[S] * in.k[D]) * window;
    const T weakened = -in.c[wake_depth] * in.c[C_m] * moment;
    F[pitching_moment] = weakened * in.q[wind_cross_axis];
    F[lateral_moment] = weakened * in.q[wind_cross_axis_lateral] + in.c[wake_push] * moment * sine * sin(delta) / in.c[wake_width];
  }

  static std::vector<Example> examples() {
    return {{.constants = {1.9554, 1.5816},
             .quantities = {736.0, 0.17364818, 0.0, -1.2, 0.17453293},
             .coefficients = {0.5, 0.15, -1.5707963, 0.384, 0.060467094},
             .ports = {-7.53583281, 35.2809083},
             .source = "21 deg beside a strut at -90 deg; q S D C_m = 23.900081 N m; by a calculator with the chord"},
            {.constants = {2.0, 1.5},
             .quantities = {100.0, 0.3, -0.1, 3.0, -0.4},
             .coefficients = {-0.2, 0.3, -2.9, 0.6, 0.5},
             .ports = {7.3578577, 15.4017658},
             .source = "across phi = pi: Delta = 5.9 rad is -0.383 rad"}};
  }
};

}  // namespace

MISFIT_EFFECT(strut_wake, StrutWake)
