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
  enum Coefficient { edge_depth, edge_push, edge_phi, edge_width, C_m };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "edge_depth", .unit = "-", .lower = -1.0, .upper = 1.0, .scale = 0.3, .doc = "part of the static moment that is taken away"},
      {.name = "edge_push", .unit = "-", .lower = -2.0, .upper = 2.0, .scale = 0.1, .doc = "sideways moment coefficient"},
      {.name = "edge_phi",
       .kind = CoefficientKind::shape,
       .value = 0.0,
       .unit = "rad",
       .lower = -6.3,
       .upper = 6.3,
       .scale = 0.2,
       .doc = "clock angle of the strut"},
      {.name = "edge_width",
       .kind = CoefficientKind::shape,
       .value = 0.4,
       .unit = "rad",
       .lower = 0.05,
       .upper = 1.5,
       .scale = 0.1,
       .doc = "half width at half height"},
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
    using std::atan2;
    using std::cos;
    using std::sin;
    constexpr double pi = 3.14159265358979323846, covered = 0.02;
    const T sine = sin(in.q[eta]);
    const T difference = in.q[phi] - in.c[edge_phi];
    const T delta = atan2(T(sin(difference)), T(cos(difference)));
    const T place = delta / (2.0 * in.c[edge_width]);
    const bool inside = value_of(place) > -1.0 && value_of(place) < 1.0;
    const T window = inside ? T(0.5 + 0.5 * cos(T(pi * place))) : T(0.0);
    const T slope = inside ? T(0.5 * sin(T(pi * place))) : T(0.0);
    const T fourth = sine * sine * sine * sine;
    const T moment = in.q[dynamic_pressure] * (in.k[S] * in.k[D]) * fourth / (fourth + covered * covered * covered * covered);
    const T weakened = -in.c[edge_depth] * in.c[C_m] * moment * window;
    F[pitching_moment] = weakened * in.q[wind_cross_axis];
    F[lateral_moment] = weakened * in.q[wind_cross_axis_lateral] + in.c[edge_push] * moment * sine * slope;
  }

  static std::vector<Example> examples() {
    return {{.constants = {2.0, 1.5},
             .quantities = {100.0, 0.3, -0.1, 0.5, 1.57079633},
             .coefficients = {0.4, 0.2, 0.1, 0.4, 0.5},
             .ports = {-4.5, 16.5},
             .source = "half way out: w = 1/2"}};
  }
};

}  // namespace

MISFIT_EFFECT(wake_with_cosine_edge, WakeWithCosineEdge)
