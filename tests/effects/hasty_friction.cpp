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

  enum Quantity { rate };
  static constexpr Role quantities[] = {{.name = "rate", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { friction, width };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "friction", .unit = "{port}", .lower = 0.0, .upper = 1e6, .scale = 1.0, .doc = "size of the friction when moving"},
      {.name = "width",
       .kind = CoefficientKind::shape,
       .value = 0.01,
       .unit = "{rate}",
       .lower = 1e-6,
       .upper = 1e6,
       .scale = 0.01,
       .doc = "width of the smoothing",
       .fixed = true,
       .scan = {.from = 0.02, .to = 0.3, .count = 3, .over = "|rate|", .smooths = true}},
  };
  static constexpr bool dissipative = true;

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::tanh;
    F[port] = -in.c[friction] * tanh(in.q[rate] / in.c[width]);
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.01}, .coefficients = {20.0, 0.01}, .ports = {-15.2318831}, .source = "20 tanh(1)"},
            {.quantities = {-1.0}, .coefficients = {3.0, 0.02}, .ports = {3.0}, .source = "fully sliding"}};
  }
};

}  // namespace

MISFIT_EFFECT(hasty_friction, HastyFriction)
