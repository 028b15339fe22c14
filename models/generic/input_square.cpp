#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// An input acts by its square: the heat of a current, the lift of a fan, the pull of a magnet. In both directions alike.
struct InputSquare {
  static constexpr const char* formula = "F = square input^2";
  static constexpr const char* symbols = "square [port/input^2], input as recorded [any]";
  static constexpr const char* valid =
      "an action that is even in the input; beside a gain of the model, also a parabola about another point";
  static constexpr const char* size = "10 A in 0.01 ohm: 1 W, 0.01 W/A^2";
  static constexpr const char* source = "Joule's law; fan laws: thrust with the square of the speed";
  static constexpr const char* excludes = "odd curves (saturation, input_dead_zone), an input that is late (input_lag, delay)";

  enum Quantity { input };
  static constexpr Role quantities[] = {{.name = "input", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { square };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "square", .unit = "{port}/{input}^2", .lower = -1e15, .upper = 1e15, .scale = 0.1, .doc = "force per square of the input"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = in.c[square] * in.q[input] * in.q[input];
  }

  static std::vector<Example> examples() {
    return {{.quantities = {10.0}, .coefficients = {0.01}, .ports = {1.0}, .source = "Joule: 10 A in 0.01 ohm"},
            {.quantities = {-3.0}, .coefficients = {-0.5}, .t = 2.0, .ports = {-4.5}, .source = "by hand: -0.5 x 9"}};
  }
};

}  // namespace

MISFIT_EFFECT(input_square, InputSquare)
