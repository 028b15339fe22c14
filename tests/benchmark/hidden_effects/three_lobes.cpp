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
  static constexpr Role quantities[] = {{"phi", "rad"}, {"eta", "rad"}};
  static constexpr Role ports[] = {{"lateral_moment", "N m"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"lobes", CoefficientKind::strength, 0.0, "N m", -1e4, 1e4, 10.0, "size of the moment"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::sin;
    constexpr double covered = 0.05;
    const T sine = sin(in.q[1]);
    const T fourth = sine * sine * sine * sine;
    F[0] = in.c[0] * sin(T(3.0 * in.q[0])) * (fourth / (fourth + covered * covered * covered * covered));
  }

  static std::vector<Example> examples() {
    return {{{}, {0.52359878, 1.57079633}, {20.0}, {}, 0.0, {19.999875}, {}, "sin 90 deg, open but for 6.25e-6"}};
  }
};

}  // namespace

MISFIT_EFFECT(three_lobes, ThreeLobes)
