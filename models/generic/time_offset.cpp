#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The clock of the recording runs late or early: a change of the time at which outputs are read.
struct TimeOffset {
  static constexpr const char* formula = "y(t) = h(x(t + offset))";
  static constexpr const char* symbols = "offset of the clock [s]";
  static constexpr const char* valid = "offsets of a few samples";
  static constexpr const char* size = "20 ms at 1 rad/s: 0.02 rad";
  static constexpr const char* source = "definition";
  static constexpr const char* excludes = "drift of the clock";
  static constexpr Role ports[] = {{"sample_time", "s"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"clock_offset", CoefficientKind::strength, 0.0, "s", -1.0, 1.0, 0.01, "offset of the clock"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[0] = in.c[0];
  }

  static std::vector<Example> examples() {
    return {{{}, {}, {0.02}, {}, 5.0, {0.02}, {}, "the offset itself"}, {{}, {}, {-0.5}, {}, 0.0, {-0.5}, {}, "early"}};
  }
};

}  // namespace

MISFIT_EFFECT(time_offset, TimeOffset)
