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

  enum Port { sample_time };
  static constexpr Role ports[] = {{.name = "sample_time", .unit = "s"}};
  enum Coefficient { clock_offset };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "clock_offset",
       .unit = "s",
       .lower = -1e6,
       .upper = 1e6,
       .scale = 0.01,
       .doc = "offset of the clock",
       .steps_as_candidate = 40.0},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y) {
    y[sample_time] = in.c[clock_offset];
  }

  static std::vector<Example> examples() {
    return {{.coefficients = {0.02}, .t = 5.0, .ports = {0.02}, .source = "the offset itself"},
            {.coefficients = {-0.5}, .ports = {-0.5}, .source = "early"}};
  }
};

}  // namespace

MISFIT_EFFECT(time_offset, TimeOffset)
