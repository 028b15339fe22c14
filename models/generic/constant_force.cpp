#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A force that is always there: a slope, a load, a leak, a bias of the actuator.
struct ConstantForce {
  static constexpr const char* formula = "F = constant_force";
  static constexpr const char* symbols = "constant_force [port]";
  static constexpr const char* valid = "a force that is constant over the recording";
  static constexpr const char* size = "a slope of 1 deg: 0.17 m/s^2";
  static constexpr const char* source = "definition";
  static constexpr const char* excludes = "drift, friction, a wrong zero of the sensor (bias)";

  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { constant_force };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "constant_force", .unit = "{port}", .lower = -1e15, .upper = 1e15, .scale = 0.1, .doc = "the force"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = in.c[ConstantForce::constant_force];
  }

  static std::vector<Example> examples() {
    return {{.coefficients = {-0.03}, .ports = {-0.03}, .source = "definition"},
            {.coefficients = {2.5}, .t = 4.0, .ports = {2.5}, .source = "at any time"}};
  }
};

}  // namespace

MISFIT_EFFECT(constant_force, ConstantForce)
