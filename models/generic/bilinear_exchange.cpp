#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// An input sets how strongly two levels act on each other: the flow in a heat exchanger, wind over a tank, a fan, a valve between vessels.
/// It acts on one of them; what the other receives is another effect of this kind.
struct BilinearExchange {
  static constexpr const char* formula = "F = exchange_per_input input (other - level)";
  static constexpr const char* symbols =
      "exchange_per_input [port/input/level], input as recorded [any], level that the port changes [any], other level [level]";
  static constexpr const char* valid =
      "flow in proportion to the input and to the difference of the levels; the other level is a state of the model or an input";
  static constexpr const char* size = "a plate in wind: 5.7 W/m^2/K in still air and 3.8 W/m^2/K more per m/s: at 1.5 m/s twice as much";
  static constexpr const char* source = "McAdams, Heat Transmission (1954): 5.7 + 3.8 v of wind over a plate, v below 5 m/s";
  static constexpr const char* excludes =
      "the exchange without the input (exchange, leak), powers of the input, what the other level loses";

  enum Quantity { input, level, other };
  static constexpr Role quantities[] = {
      {.name = "input", .unit = "*"}, {.name = "level", .unit = "*"}, {.name = "other", .unit = "{level}", .input_too = true}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { exchange_per_input };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "exchange_per_input",
       .unit = "{port}/{input}/{level}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "flow per input and difference of the levels"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = in.c[exchange_per_input] * in.q[input] * (in.q[other] - in.q[level]);
  }

  static std::vector<Example> examples() {
    return {{.quantities = {1.5, 50.0, 10.0},
             .coefficients = {3.8},
             .ports = {-228.0},
             .source = "McAdams, Heat Transmission (1954): 3.8 x 1.5 x -40"},
            {.quantities = {0.5, 1.0, 3.0}, .coefficients = {-0.1}, .t = 3.0, .ports = {-0.1}, .source = "by hand: -0.1 x 0.5 x 2"}};
  }
};

}  // namespace

MISFIT_EFFECT(bilinear_exchange, BilinearExchange)
