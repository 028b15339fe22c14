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
  static constexpr Role quantities[] = {{"displacement", "*"}};
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {{"cubic_stiffness", CoefficientKind::strength, 0.0,
                                                      "{port}/{displacement}/{displacement}/{displacement}", -1e12, 1e12, 1.0,
                                                      "force per cube of the displacement; positive hardens"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[0] = -in.c[0] * in.q[0] * in.q[0] * in.q[0];
  }

  static std::vector<Example> examples() {
    return {{{}, {2.0}, {0.75}, {}, 0.0, {-6.0}, {}, "by hand: 0.75 x 8, against the displacement"},
            {{}, {-0.5}, {-4.0}, {}, 0.0, {-0.5}, {}, "softening: 4 x 0.125 away from zero"}};
  }
};

}  // namespace

MISFIT_EFFECT(cubic_stiffness, CubicStiffness)
