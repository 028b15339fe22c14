#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// An error of a sensor of which only the quantity is known that it depends on: a calibration curve that nobody has measured.
struct UnknownError {
  static constexpr const char* formula = "y = h(x) + unknown_error(of)";
  static constexpr const char* symbols = "unknown_error [output], a curve (cubic spline) of the quantity `of` [any]; y the output";
  static constexpr const char* valid = "a function of one quantity, where that was visited; beyond, the curve goes on straight";
  static constexpr const char* size = "a level sensor of 10 V that is not straight by 1 %: 0.1 V";
  static constexpr const char* source =
      "JCGM 200:2012 (VIM), 4.31 calibration curve; JCGM 100:2008 (GUM), 3.2.3: a recognised systematic effect is corrected for";
  static constexpr const char* excludes =
      "dependence on a second quantity or on the past; what the model has already (its parameter is fixed)";

  enum Quantity { of };
  static constexpr Role quantities[] = {{.name = "of", .unit = "*"}};
  enum Port { output };
  static constexpr Role ports[] = {{.name = "output", .unit = "*"}};
  enum Coefficient { unknown_error };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "unknown_error", .unit = "{output}", .lower = -1e15, .upper = 1e15, .scale = 0.01, .doc = "the error", .curve_of = "of"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[output] = in.c[UnknownError::unknown_error];
  }

  static std::vector<Example> examples() {
    return {{.quantities = {3.0}, .coefficients = {0.002}, .ports = {0.002}, .source = "the value of the curve there"},
            {.quantities = {-0.2}, .coefficients = {-7.5}, .t = 3.0, .ports = {-7.5}, .source = "whatever the time"}};
  }
};

}  // namespace

MISFIT_EFFECT(unknown_error, UnknownError)
