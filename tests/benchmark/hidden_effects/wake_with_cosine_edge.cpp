#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The wake of a strut in another form than the one that is offered (strut_wake): a window with an end, half of a cosine wave wide.
struct WakeWithCosineEdge {
  static constexpr const char* formula =
      "M_in-plane = -edge_depth w q S D C_m, M_lateral = q S D sin(eta) edge_push w' edge_width, w = (1 + cos(pi Delta/(2 edge_width)))/2 "
      "inside |Delta| < 2 edge_width, else 0";
  static constexpr const char* symbols = "Delta = phi - edge_phi, edge_phi, edge_width [rad]; edge_depth, edge_push [-]";
  static constexpr const char* valid = "simulation";
  static constexpr const char* size = "as strut_wake";
  static constexpr const char* source = "made up for the bench";
  static constexpr const char* excludes = "everything else";
  static constexpr Role quantities[] = {
      {"dynamic_pressure", "Pa"}, {"wind_cross_axis", "-"}, {"wind_cross_axis_lateral", "-"}, {"phi", "rad"}, {"eta", "rad"}};
  static constexpr Role ports[] = {{"pitching_moment", "N m"}, {"lateral_moment", "N m"}};
  static constexpr const char* constants[] = {"S", "D"};
  static constexpr CoefficientSpec coefficients[] = {
      {"edge_depth", CoefficientKind::strength, 0.0, "-", -1.0, 1.0, 0.3, "part of the static moment that is taken away"},
      {"edge_push", CoefficientKind::strength, 0.0, "-", -2.0, 2.0, 0.1, "sideways moment coefficient"},
      {"edge_phi", CoefficientKind::shape, 0.0, "rad", -6.3, 6.3, 0.2, "clock angle of the strut"},
      {"edge_width", CoefficientKind::shape, 0.4, "rad", 0.05, 1.5, 0.1, "half width at half height"},
      borrowed_coefficient("C_m", "-", "static moment coefficient over the sine of alpha_T")};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::atan2;
    using std::cos;
    using std::sin;
    constexpr double pi = 3.14159265358979323846, covered = 0.02;
    const T sine = sin(in.q[4]);
    const T difference = in.q[3] - in.c[2];
    const T delta = atan2(T(sin(difference)), T(cos(difference)));
    const T place = delta / (2.0 * in.c[3]);
    const bool inside = value_of(place) > -1.0 && value_of(place) < 1.0;
    const T window = inside ? T(0.5 + 0.5 * cos(T(pi * place))) : T(0.0);
    const T slope = inside ? T(0.5 * sin(T(pi * place))) : T(0.0);
    const T fourth = sine * sine * sine * sine;
    const T moment = in.q[0] * (in.k[0] * in.k[1]) * fourth / (fourth + covered * covered * covered * covered);
    const T weakened = -in.c[0] * in.c[4] * moment * window;
    F[0] = weakened * in.q[1];
    F[1] = weakened * in.q[2] + in.c[1] * moment * sine * slope;
  }

  static std::vector<Example> examples() {
    return {
        {{2.0, 1.5}, {100.0, 0.3, -0.1, 0.5, 1.57079633}, {0.4, 0.2, 0.1, 0.4, 0.5}, {}, 0.0, {-4.5, 16.5}, {}, "half way out: w = 1/2"}};
  }
};

}  // namespace

MISFIT_EFFECT(wake_with_cosine_edge, WakeWithCosineEdge)
