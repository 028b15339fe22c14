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

  enum Quantity { phi };
  static constexpr misfit::Role quantities[] = {{.name = "phi", .unit = "rad"}};
  enum Port { pitching_moment };
  static constexpr misfit::Role ports[] = {{.name = "pitching_moment", .unit = "N m"}};
  enum Coefficient { M_strut, w };
  static constexpr misfit::CoefficientSpec coefficients[] = {
      {.name = "M_strut", .unit = "N m", .lower = -500.0, .upper = 500.0, .scale = 5.0, .doc = "moment straight behind the strut"},
      {.name = "w",
       .kind = misfit::CoefficientKind::shape,
       .value = 0.5,
       .unit = "rad",
       .lower = 0.05,
       .upper = 3.0,
       .scale = 0.2,
       .doc = "width"},
  };

  template <class T, class K>
  static void add(const misfit::Reads<T, K>& in, T* F) {
    using std::exp;
    const T x = in.q[phi] / in.c[w];
    F[pitching_moment] = in.c[M_strut] * exp(-x * x);
  }

  static std::vector<misfit::Example> examples() {
    return {{.quantities = {0.5}, .coefficients = {10.0, 0.5}, .ports = {3.6787944}, .source = "by hand: 10/e"}};
  }
};

}  // namespace

MISFIT_EFFECT(strut_interference, StrutInterference)
