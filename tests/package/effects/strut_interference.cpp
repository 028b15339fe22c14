#include "misfit/model/registry.h"

namespace {

/// A moment that is largest where the canopy hangs straight behind a strut.
struct StrutInterference {
  static constexpr const char* formula = "M = M_strut exp(-(phi/w)^2)";
  static constexpr const char* symbols = "M_strut [N m], phi clock angle [rad], w [rad]";
  static constexpr const char* valid = "one strut, straight down";
  static constexpr const char* size = "1 N m and more, by the strut";
  static constexpr const char* source = "made up for the test of the package";
  static constexpr const char* excludes = "sideways push";
  static constexpr misfit::Role quantities[] = {{"phi", "rad"}};
  static constexpr misfit::Role ports[] = {{"pitching_moment", "N m"}};
  static constexpr misfit::CoefficientSpec coefficients[] = {
      {"M_strut", misfit::CoefficientKind::strength, 0.0, "N m", -500.0, 500.0, 5.0, "moment straight behind the strut"},
      {"w", misfit::CoefficientKind::shape, 0.5, "rad", 0.05, 3.0, 0.2, "width"}};

  template <class T, class K>
  static void add(const misfit::Reads<T, K>& in, T* F) {
    using std::exp;
    const T x = in.q[0] / in.c[1];
    F[0] = in.c[0] * exp(-x * x);
  }

  static std::vector<misfit::Example> examples() { return {{{}, {0.5}, {10.0, 0.5}, {}, 0.0, {3.6787944}, {}, "by hand: 10/e"}}; }
};

}  // namespace

MISFIT_EFFECT(strut_interference, StrutInterference)
