#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A force of which only the quantity is known that it depends on: a stand-in until its form has a name.
struct UnknownForce {
  static constexpr const char* formula = "F = unknown_force(of)";
  static constexpr const char* symbols = "unknown_force [port], a curve (cubic spline) of the quantity `of` [any]";
  static constexpr const char* valid = "a function of one quantity, where that was visited; beyond, the curve goes on straight";
  static constexpr const char* size = "dry friction of a bearing, as a curve of its rate: -F for negative and +F for positive rates";
  static constexpr const char* source = "J. Sjoberg et al., Nonlinear black-box modeling in system identification, Automatica 31 (1995)";
  static constexpr const char* excludes =
      "dependence on a second quantity or on the past; what the model has already (its parameter is fixed)";

  enum Quantity { of };
  static constexpr Role quantities[] = {{.name = "of", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { unknown_force };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "unknown_force", .unit = "{port}", .lower = -1e15, .upper = 1e15, .scale = 0.1, .doc = "the force", .curve_of = "of"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = in.c[UnknownForce::unknown_force];
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.4}, .coefficients = {-0.03}, .ports = {-0.03}, .source = "the value of the curve there"},
            {.quantities = {-7.0}, .coefficients = {2.5}, .t = 4.0, .ports = {2.5}, .source = "at any time"}};
  }
};

}  // namespace

MISFIT_EFFECT(unknown_force, UnknownForce)
