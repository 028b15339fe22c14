#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sideways moment with three lobes around the clock: no effect of the library has that shape.
struct ThreeLobes {
  static constexpr const char* formula = "M_lateral = lobes sin(3 phi) sin^4(eta)/(sin^4(eta) + 0.05^4)";
  static constexpr const char* symbols = "lobes [N m], phi clock angle, eta tilt [rad]";
  static constexpr const char* valid = "simulation";
  static constexpr const char* size = "some N m";
  static constexpr const char* source = "made up for the bench";
  static constexpr const char* excludes = "everything else";

  enum Quantity { phi, eta };
  static constexpr Role quantities[] = {{.name = "phi", .unit = "rad"}, {.name = "eta", .unit = "rad"}};
  enum Port { lateral_moment };
  static constexpr Role ports[] = {{.name = "lateral_moment", .unit = "N m"}};
  enum Coefficient { lobes };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "lobes", .unit = "N m", .lower = -1e4, .upper = 1e4, .scale = 10.0, .doc = "size of the moment"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::sin;
    constexpr double covered = 0.05;
    const T sine = sin(in.q[eta]);
    const T fourth = sine * sine * sine * sine;
    F[lateral_moment] = in.c[lobes] * sin(T(3.0 * in.q[phi])) * (fourth / (fourth + covered * covered * covered * covered));
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.52359878, 1.57079633},
             .coefficients = {20.0},
             .ports = {19.999875},
             .source = "sin 90 deg, open but for 6.25e-6"}};
  }
};

}  // namespace

MISFIT_EFFECT(three_lobes, ThreeLobes)
