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

  enum Quantity { displacement };
  static constexpr Role quantities[] = {{.name = "displacement", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { quadratic_stiffness, quintic_stiffness };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "quadratic_stiffness",
       .unit = "{port}/{displacement}/{displacement}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 1.0,
       .doc = "force per square of the displacement: the asymmetry"},
      {.name = "quintic_stiffness",
       .unit = "{port}/{displacement}/{displacement}/{displacement}/{displacement}/{displacement}",
       .lower = -1e18,
       .upper = 1e18,
       .scale = 1.0,
       .doc = "force per fifth power of the displacement"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T square = in.q[displacement] * in.q[displacement];
    F[port] = -(in.c[quadratic_stiffness] + in.c[quintic_stiffness] * in.q[displacement] * square) * square;
  }

  static std::vector<Example> examples() {
    return {{.quantities = {2.0}, .coefficients = {0.5, 0.25}, .ports = {-10.0}, .source = "by hand: 0.5 x 4 + 0.25 x 32"},
            {.quantities = {-1.0}, .coefficients = {3.0, -2.0}, .ports = {-5.0}, .source = "by hand: -(3 x 1 - 2 x -1)"}};
  }
};

}  // namespace

MISFIT_EFFECT(polynomial_stiffness, PolynomialStiffness)
