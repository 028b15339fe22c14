#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The input acts on this port more or less than the model has it, or where the model has none of it: a wrong gain, a second path.
struct InputGain {
  static constexpr const char* formula = "F = gain_error input";
  static constexpr const char* symbols = "gain_error [port/input], input as recorded [any]";
  static constexpr const char* valid = "an input that acts at once and in proportion";
  static constexpr const char* size = "a gain that is 5 % wrong: 5 % of what the input does";
  static constexpr const char* source = "definition";
  static constexpr const char* excludes = "offset (input_offset), saturation, delay of the input";

  enum Quantity { input };
  static constexpr Role quantities[] = {{.name = "input", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { gain_error };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "gain_error",
       .unit = "{port}/{input}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "force per input beside what the model has"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = in.c[gain_error] * in.q[input];
  }

  static std::vector<Example> examples() {
    return {{.quantities = {2.5}, .coefficients = {0.4}, .ports = {1.0}, .source = "by hand: 0.4 x 2.5"},
            {.quantities = {-3.0}, .coefficients = {0.2}, .t = 7.0, .ports = {-0.6}, .source = "by hand: 0.2 x -3"}};
  }
};

}  // namespace

MISFIT_EFFECT(input_gain, InputGain)
