#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The input has a zero of its own: a constant on the port. The role `input` says whose zero it is and is not read; its recorded value may
/// be anything.
struct InputOffset {
  static constexpr const char* formula = "F = offset";
  static constexpr const char* symbols = "offset [port]: zero of the input times its gain, input [any] (only named)";
  static constexpr const char* valid = "an offset that is constant over the recording";
  static constexpr const char* size = "a pump that needs 0.3 V before it delivers: -0.3 V times its gain";
  static constexpr const char* source = "definition";
  static constexpr const char* specialises = "constant_force";
  static constexpr const char* excludes = "wrong gain (input_gain), drift, a dead zone of the input";

  enum Quantity { input };
  static constexpr Role quantities[] = {{.name = "input", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { input_offset };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "input_offset",
       .unit = "{port}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "constant beside what the recorded input does"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = in.c[input_offset];
  }

  static std::vector<Example> examples() {
    return {{.quantities = {2.0}, .coefficients = {-0.03}, .ports = {-0.03}, .source = "the offset itself, whatever the input"},
            {.quantities = {0.0}, .coefficients = {1.5}, .t = 4.0, .ports = {1.5}, .source = "and at any time"}};
  }
};

}  // namespace

MISFIT_EFFECT(input_offset, InputOffset)
