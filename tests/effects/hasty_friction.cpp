#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// coulomb_friction without its fastest rate: what it costs not to announce it.
struct HastyFriction {
  static constexpr const char* formula = "F = -friction tanh(rate/width)";
  static constexpr const char* symbols = "friction [port], width [rate], rate [any]";
  static constexpr const char* valid = "never at frame rate";
  static constexpr const char* size = "as coulomb_friction";
  static constexpr const char* source = "as coulomb_friction";
  static constexpr const char* excludes = "sub-stepping";
  static constexpr Role quantities[] = {{"rate", "*"}};
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"friction", CoefficientKind::strength, 0.0, "{port}", 0.0, 1e6, 1.0, "size of the friction when moving"},
      {"width", CoefficientKind::shape, 0.01, "{rate}", 1e-6, 1e6, 0.01, "width of the smoothing", Parity::none, "", false, true}};
  static constexpr bool dissipative = true;

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::tanh;
    F[0] = -in.c[0] * tanh(in.q[0] / in.c[1]);
  }

  static std::vector<Example> examples() {
    return {{{}, {0.01}, {20.0, 0.01}, {}, 0.0, {-15.2318831}, {}, "20 tanh(1)"},
            {{}, {-1.0}, {3.0, 0.02}, {}, 0.0, {3.0}, {}, "fully sliding"}};
  }
};

}  // namespace

MISFIT_EFFECT(hasty_friction, HastyFriction)
