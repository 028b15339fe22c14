#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor that reads too much by a constant.
struct Bias {
  static constexpr const char* formula = "y = h(x) + offset";
  static constexpr const char* symbols = "offset [output], y the output [any]";
  static constexpr const char* valid = "an offset that is constant over the recording";
  static constexpr const char* size = "0.1 deg on the tilt moves the trim by 0.1 deg";
  static constexpr const char* source = "JCGM 100:2008 (GUM), 3.2.3: a recognised systematic effect is corrected for";
  static constexpr const char* excludes = "drift, wrong scale";

  enum Port { output };
  static constexpr Role ports[] = {{.name = "output", .unit = "*"}};
  enum Coefficient { offset };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "offset", .unit = "{output}", .lower = -1e15, .upper = 1e15, .scale = 0.01, .doc = "output where the true value is 0"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[output] = in.c[offset];
  }

  static std::vector<Example> examples() {
    return {{.coefficients = {0.002}, .ports = {0.002}, .source = "the output moves by the offset"},
            {.coefficients = {-7.5}, .t = 3.0, .ports = {-7.5}, .source = "whatever the time"}};
  }
};

}  // namespace

MISFIT_EFFECT(bias, Bias)
