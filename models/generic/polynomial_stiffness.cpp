#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// What cubic_stiffness leaves of a smooth spring: its asymmetry (even) and the next odd term.
struct PolynomialStiffness {
  static constexpr const char* formula = "F = -(quadratic_stiffness displacement^2 + quintic_stiffness displacement^5)";
  static constexpr const char* symbols =
      "quadratic_stiffness [port/displacement^2], quintic_stiffness [port/displacement^5], displacement from the origin that the linear "
      "stiffness has [any]";
  static constexpr const char* valid = "smooth springs; outside the visited displacements the fifth power means nothing";
  static constexpr const char* size = "an origin that is off by d makes 3 d cubic_stiffness of the quadratic one";
  static constexpr const char* source = "Taylor series of the restoring force; Nayfeh and Mook, Nonlinear Oscillations (1979), section 2.3";
  static constexpr const char* excludes = "the cubic term (cubic_stiffness), corners (dead_zone)";
  static constexpr Role quantities[] = {{"displacement", "*"}};
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"quadratic_stiffness", CoefficientKind::strength, 0.0, "{port}/{displacement}/{displacement}", -1e12, 1e12, 1.0,
       "force per square of the displacement: the asymmetry"},
      {"quintic_stiffness", CoefficientKind::strength, 0.0,
       "{port}/{displacement}/{displacement}/{displacement}/{displacement}/{displacement}", -1e18, 1e18, 1.0,
       "force per fifth power of the displacement"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T square = in.q[0] * in.q[0];
    F[0] = -(in.c[0] + in.c[1] * in.q[0] * square) * square;
  }

  static std::vector<Example> examples() {
    return {{{}, {2.0}, {0.5, 0.25}, {}, 0.0, {-10.0}, {}, "by hand: 0.5 x 4 + 0.25 x 32"},
            {{}, {-1.0}, {3.0, -2.0}, {}, 0.0, {-5.0}, {}, "by hand: -(3 x 1 - 2 x -1)"}};
  }
};

}  // namespace

MISFIT_EFFECT(polynomial_stiffness, PolynomialStiffness)
