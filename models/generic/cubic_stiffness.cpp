#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The odd nonlinearity of a spring, next after its stiffness: hardening if positive, softening if negative (a pendulum).
struct CubicStiffness {
  static constexpr const char* formula = "F = -cubic_stiffness displacement^3";
  static constexpr const char* symbols =
      "cubic_stiffness [port/displacement^3], displacement measured from where the spring is symmetric [any]";
  static constexpr const char* valid = "displacements small enough for the next odd term to be small beside it";
  static constexpr const char* size = "pendulum: sin(x) = x - x^3/6, a cubic stiffness of -1/6 of the linear one per rad^2";
  static constexpr const char* source = "Duffing, Erzwungene Schwingungen bei veraenderlicher Eigenfrequenz (1918)";
  static constexpr const char* excludes = "asymmetry and higher terms (polynomial_stiffness), stops (dead_zone)";

  enum Quantity { displacement };
  static constexpr Role quantities[] = {{.name = "displacement", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { cubic_stiffness };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "cubic_stiffness",
       .unit = "{port}/{displacement}/{displacement}/{displacement}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 1.0,
       .doc = "force per cube of the displacement; positive hardens"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = -in.c[cubic_stiffness] * in.q[displacement] * in.q[displacement] * in.q[displacement];
  }

  static std::vector<Example> examples() {
    return {{.quantities = {2.0}, .coefficients = {0.75}, .ports = {-6.0}, .source = "by hand: 0.75 x 8, against the displacement"},
            {.quantities = {-0.5}, .coefficients = {-4.0}, .ports = {-0.5}, .source = "softening: 4 x 0.125 away from zero"}};
  }
};

}  // namespace

MISFIT_EFFECT(cubic_stiffness, CubicStiffness)
