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
  static constexpr Role quantities[] = {{"input", "*"}};
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"gain_error", CoefficientKind::strength, 0.0, "{port}/{input}", -1e12, 1e12, 0.1, "force per input beside what the model has"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[0] = in.c[0] * in.q[0];
  }

  static std::vector<Example> examples() {
    return {{{}, {2.5}, {0.4}, {}, 0.0, {1.0}, {}, "by hand: 0.4 x 2.5"}, {{}, {-3.0}, {0.2}, {}, 7.0, {-0.6}, {}, "by hand: 0.2 x -3"}};
  }
};

}  // namespace

MISFIT_EFFECT(input_gain, InputGain)
