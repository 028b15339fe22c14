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
      "C_m of the static moment [-], along the felt wind as that is; phi clock angle, wake_phi, width [rad]; eta tilt; depth, push [-]";
  static constexpr const char* valid = "quasi-steady; one strut; the wake reaches as far out as the tilts that are visited";
  static constexpr const char* size = "push = 0.15 at eta = 12 deg and one width from the centre: 43 N m, more than the random moment";
  static constexpr const char* source =
      "paper, Parachute Attitude Measurements: the parachute tends not to travel through the wake of the strut; the form is ours";
  static constexpr const char* excludes = "unsteadiness of the wake (vortex_shedding), its end in radius, weaker damping inside it";
  static constexpr Role quantities[] = {
      {"dynamic_pressure", "Pa"}, {"wind_cross_axis", "-"}, {"wind_cross_axis_lateral", "-"}, {"phi", "rad"}, {"eta", "rad"}};
  static constexpr Role ports[] = {{"pitching_moment", "N m"}, {"lateral_moment", "N m"}};
  static constexpr const char* constants[] = {"S", "D"};
  static constexpr CoefficientSpec coefficients[] = {
      {"wake_depth", CoefficientKind::strength, 0.0, "-", -1.0, 1.0, 0.3, "part of the static moment that the wake takes away"},
      {"wake_push", CoefficientKind::strength, 0.0, "-", -2.0, 2.0, 0.1, "sideways moment coefficient; positive: away from the wake"},
      {"wake_phi",
       CoefficientKind::shape,
       0.0,
       "rad",
       -6.3,
       6.3,
       0.2,
       "clock angle of the strut",
       Parity::none,
       "",
       false,
       false,
       {-3.0543262, 3.0543262, 36}},
      {"wake_width",
       CoefficientKind::shape,
       0.4,
       "rad",
       0.05,
       1.6,
       0.1,
       "half width: where the window has 61 % of its height",
       Parity::none,
       "",
       false,
       false,
       {0.2, 0.6, 3}},
      borrowed_coefficient("C_m", "-", "static moment coefficient over the sine of alpha_T")};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::cos;
    using std::exp;
    using std::sin;
    constexpr double covered = 0.02;  // sine of the tilt below which the canopy, 0.8 m wide 3 m downstream, covers all sectors
    const T sine = sin(in.q[4]);
    const T delta = in.q[3] - in.c[2];
    const T fourth = sine * sine * sine * sine;
    const T open = fourth / (fourth + covered * covered * covered * covered);
    const T window = open * exp(T((cos(delta) - 1.0) / (in.c[3] * in.c[3])));
    const T moment = in.q[0] * (in.k[0] * in.k[1]) * window;
    const T weakened = -in.c[0] * in.c[4] * moment;
    F[0] = weakened * in.q[1];
    F[1] = weakened * in.q[2] + in.c[1] * moment * sine * sin(delta) / in.c[3];
  }

  static std::vector<Example> examples() {
    return {{{1.9554, 1.5816},
             {736.0, 0.17364818, 0.0, -1.2, 0.17453293},
             {0.5, 0.15, -1.5707963, 0.384, 0.060467094},
             {},
             0.0,
             {-7.53583281, 35.2809083},
             {},
             "21 deg beside a strut at -90 deg; q S D C_m = 23.900081 N m; by a calculator with the chord"},
            {{2.0, 1.5},
             {100.0, 0.3, -0.1, 3.0, -0.4},
             {-0.2, 0.3, -2.9, 0.6, 0.5},
             {},
             0.0,
             {7.3578577, 15.4017658},
             {},
             "across phi = pi: Delta = 5.9 rad is -0.383 rad"}};
  }
};

}  // namespace

MISFIT_EFFECT(strut_wake, StrutWake)
