#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Two outputs read along axes that are turned by an angle: a camera that is rolled about its line of sight, a sensor that is mounted
/// askew.
struct OutputRotation {
  static constexpr const char* formula = "y = h cos a - h_other sin a,  y_other = h sin a + h_other cos a";
  static constexpr const char* symbols = "h, h_other predicted outputs along axes at a right angle [output], a angle of the axes [rad]";
  static constexpr const char* valid = "both along perpendicular axes in one unit, from one origin; any angle below a quarter turn";
  static constexpr const char* size = "0.017 of the other output for 1 deg";
  static constexpr const char* source = "plane rotation: Goldstein, Classical Mechanics (1980), Eq. 4-18";
  static constexpr const char* excludes = "an origin that is off (bias), different scales, axes that are not square (cross_talk)";

  enum Quantity { signal, other_signal };
  static constexpr Role quantities[] = {{.name = "signal", .unit = "*"}, {.name = "other_signal", .unit = "{signal}"}};
  enum Port { output, other_output };
  static constexpr Role ports[] = {{.name = "output", .unit = "{signal}"}, {.name = "other_output", .unit = "{signal}"}};
  enum Coefficient { rotation };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "rotation", .unit = "rad", .lower = -1.5, .upper = 1.5, .scale = 0.02, .doc = "angle from output towards other_output"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    using std::cos;
    using std::sin;
    const T less = cos(in.c[rotation]) - 1.0, across = sin(in.c[rotation]);
    y[output] = in.q[signal] * less - in.q[other_signal] * across;
    y[other_output] = in.q[signal] * across + in.q[other_signal] * less;
  }

  static std::vector<Example> examples() {
    return {
        {.quantities = {3.0, 4.0},
         .coefficients = {0.52359877559829887},
         .ports = {-2.40192379, 0.96410162},
         .source = "30 deg: (3, 4) becomes (3 x 0.866025404 - 2, 1.5 + 4 x 0.866025404)"},
        {.quantities = {1.0, 0.0}, .coefficients = {-0.1}, .ports = {-0.00499583472, -0.0998334166}, .source = "cos 0.1 - 1 and -sin 0.1"}};
  }
};

}  // namespace

MISFIT_EFFECT(output_rotation, OutputRotation)
