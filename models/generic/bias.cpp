#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor that reads too much by a constant.
struct Bias {
  static constexpr const char* formula = "y = h(x) + offset";
  static constexpr const char* symbols = "offset [output], y the reading [any]";
  static constexpr const char* valid = "an offset that is constant over the recording";
  static constexpr const char* size = "0.1 deg on the tilt moves the trim by 0.1 deg";
  static constexpr const char* source = "JCGM 100:2008 (GUM), 3.2.3: a recognised systematic effect is corrected for";
  static constexpr const char* excludes = "drift, wrong scale";
  static constexpr Role ports[] = {{"output", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"offset", CoefficientKind::strength, 0.0, "{output}", -1e6, 1e6, 0.01, "reading where the true value is 0"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[0] = in.c[0];
  }

  static std::vector<Example> examples() {
    return {{{}, {}, {0.002}, {}, 0.0, {0.002}, {}, "the reading moves by the offset"},
            {{}, {}, {-7.5}, {}, 3.0, {-7.5}, {}, "whatever the time"}};
  }
};

}  // namespace

MISFIT_EFFECT(bias, Bias)
