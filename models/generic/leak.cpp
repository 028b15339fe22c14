#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A level loses in proportion to how far it stands above its surroundings: heat through a wall, water through a crack, charge through an
/// insulation. Where the rest of the model knows the level's own decay already the two cannot be distinguished, and discovery says so.
struct Leak {
  static constexpr const char* formula = "F = -leak (content - surroundings)";
  static constexpr const char* symbols = "leak [port/content], content that the port changes [any], surroundings that it ends at [content]";
  static constexpr const char* valid = "flow in proportion to the difference; surroundings that do not change";
  static constexpr const char* size = "a body of 100 J/K losing 0.1 W/K: 1 mK/s per kelvin, a time constant of 1000 s";
  static constexpr const char* source = "Newton's law of cooling (Phil. Trans. 22, 1701)";
  static constexpr const char* excludes = "what another level of the model receives (exchange), radiation, outflow over an edge (overflow)";

  enum Quantity { content };
  static constexpr Role quantities[] = {{.name = "content", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { leak, surroundings };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "leak",
       .unit = "{port}/{content}",
       .lower = 0.0,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "loss per content above the surroundings"},
      {.name = "surroundings",
       .kind = CoefficientKind::shape,
       .value = 0.0,
       .unit = "{content}",
       .lower = -1e12,
       .upper = 1e12,
       .scale = 1.0,
       .doc = "content at which nothing is lost",
       .fixed = true},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = -in.c[Leak::leak] * (in.q[content] - in.c[surroundings]);
  }

  static std::vector<Example> examples() {
    return {{.quantities = {35.0}, .coefficients = {0.01, 20.0}, .ports = {-0.15}, .source = "by hand: 0.01 x 15"},
            {.quantities = {1.0}, .coefficients = {2.0, 4.0}, .t = 3.0, .ports = {6.0}, .source = "by hand: 2 x 3, inwards"}};
  }
};

}  // namespace

MISFIT_EFFECT(leak, Leak)
