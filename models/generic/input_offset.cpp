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
  static constexpr const char* excludes = "wrong gain (input_gain), drift, a dead zone of the input";
  static constexpr Role quantities[] = {{"input", "*"}};
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"input_offset", CoefficientKind::strength, 0.0, "{port}", -1e12, 1e12, 0.1, "constant beside what the recorded input does"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[0] = in.c[0];
  }

  static std::vector<Example> examples() {
    return {{{}, {2.0}, {-0.03}, {}, 0.0, {-0.03}, {}, "the offset itself, whatever the input"},
            {{}, {0.0}, {1.5}, {}, 4.0, {1.5}, {}, "and at any time"}};
  }
};

}  // namespace

MISFIT_EFFECT(input_offset, InputOffset)
