#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A stop on one side: a spring that acts only below an edge (the ground under what falls, a chain that tightens when it is let down). Its
/// mirror image is upper_stop; equal stops on both sides are dead_zone.
struct LowerStop {
  static constexpr const char* formula = "F = -stop_stiffness (displacement - edge) below the edge, else 0";
  static constexpr const char* symbols = "stop_stiffness [port/displacement], edge [displacement], displacement [any]";
  static constexpr const char* valid =
      "elastic contact without loss; the derivative at the corner is that of the side the displacement is on";
  static constexpr const char* size = "a rubber stop of 150 N m/rad, entered by 2 deg: 5 N m";
  static constexpr const char* source = "den Hartog, Mechanical Vibrations (1956), section 8.9: springs with stops, here on one side";
  static constexpr const char* excludes = "loss in the contact, a stop on the other side (upper_stop)";

  enum Quantity { displacement };
  static constexpr Role quantities[] = {{.name = "displacement", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { stop_stiffness, edge };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "stop_stiffness",
       .unit = "{port}/{displacement}",
       .lower = 0.0,
       .upper = 1e15,
       .scale = 1.0,
       .doc = "force per displacement below the edge"},
      {.name = "edge",
       .kind = CoefficientKind::shape,
       .value = 1.0,
       .unit = "{displacement}",
       .lower = -1e12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "displacement at which the stop is met",
       .scan = {.from = 0.05, .to = 0.5, .count = 5, .over = "displacement"}},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = in.c[stop_stiffness] * above(T(in.c[edge] - in.q[displacement]));
  }

  static std::vector<Example> examples() {
    return {{.quantities = {-0.5}, .coefficients = {150.0, -0.2}, .ports = {45.0}, .source = "by hand: 150 x 0.3, back"},
            {.quantities = {1.0}, .coefficients = {4.0, 1.5}, .ports = {2.0}, .source = "by hand: 4 x 0.5, back"},
            {.quantities = {-0.1}, .coefficients = {150.0, -0.2}, .ports = {0.0}, .source = "free of the stop"}};
  }
};

}  // namespace

MISFIT_EFFECT(lower_stop, LowerStop)
