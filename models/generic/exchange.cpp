#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Two levels of one kind act on each other: heat between bodies, liquid between vessels, charge between capacitors. It acts on one of
/// them; what the other receives is another effect of this kind, with a strength of its own (the capacities differ).
struct Exchange {
  static constexpr const char* formula = "F = exchange (other - level)";
  static constexpr const char* symbols = "exchange [port/level], level that the port changes [any], other level [level]";
  static constexpr const char* valid = "flow in proportion to the difference; the other level is a state of the model or measured";
  static constexpr const char* size =
      "two bodies of 100 J/K joined by 0.5 W/K: 5 mK/s per kelvin, a time constant of 100 s, of 200 s where the other is held";
  static constexpr const char* source = "Newton's law of cooling (Phil. Trans. 22, 1701) between two bodies";
  static constexpr const char* excludes = "radiation, one-way flow (overflow_into), what the other level loses";

  enum Quantity { level, other };
  static constexpr Role quantities[] = {{.name = "level", .unit = "*"}, {.name = "other", .unit = "{level}"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { exchange };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "exchange", .unit = "{port}/{level}", .lower = 0.0, .upper = 1e15, .scale = 0.1, .doc = "flow per difference of the levels"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = in.c[Exchange::exchange] * (in.q[other] - in.q[level]);
  }

  static std::vector<Example> examples() {
    return {{.quantities = {20.0, 35.0}, .coefficients = {0.01}, .ports = {0.15}, .source = "by hand: 0.01 x 15"},
            {.quantities = {4.0, 1.0}, .coefficients = {2.0}, .t = 3.0, .ports = {-6.0}, .source = "by hand: 2 x -3"}};
  }
};

}  // namespace

MISFIT_EFFECT(exchange, Exchange)
