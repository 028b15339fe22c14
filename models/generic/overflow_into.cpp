#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// What a level spills above a threshold arrives at another port: the tank below. An increment beside overflow, which takes it from the
/// level: a spill that is caught in part has both, with thresholds that should agree.
struct OverflowInto {
  static constexpr const char* formula = "F = caught (level - threshold) above the threshold, else 0";
  static constexpr const char* symbols =
      "caught [to_port/level], threshold caught_threshold [level], level that spills [any], to_port where it arrives [any]";
  static constexpr const char* valid = "arrives at once and in proportion to the height above the edge";
  static constexpr const char* size = "caught = overflow.spill where all of it arrives in a tank of the same area";
  static constexpr const char* source =
      "cascaded tanks: Schoukens, Mattsson, Wigren, Noel (2016), section 2: the upper tank overflows in part into the lower one";
  static constexpr const char* excludes = "what the upper level loses (overflow), delay on the way";

  enum Quantity { level };
  static constexpr Role quantities[] = {{.name = "level", .unit = "*"}};
  enum Port { to_port };
  static constexpr Role ports[] = {{.name = "to_port", .unit = "*"}};
  enum Coefficient { caught, caught_threshold };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "caught",
       .unit = "{to_port}/{level}",
       .lower = 0.0,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "inflow per level above the threshold"},
      {.name = "caught_threshold",
       .kind = CoefficientKind::shape,
       .value = 1.0,
       .unit = "{level}",
       .lower = -1e12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "level of the edge",
       .scan = {.from = 0.5, .to = 0.98, .count = 7, .over = "level"}},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[to_port] = in.c[caught] * above(T(in.q[level] - in.c[caught_threshold]));
  }

  static std::vector<Example> examples() {
    return {{.quantities = {10.5}, .coefficients = {0.4, 10.0}, .ports = {0.2}, .source = "by hand: 0.4 x 0.5"},
            {.quantities = {-1.0}, .coefficients = {2.0, -1.5}, .ports = {1.0}, .source = "by hand: 2 x 0.5"}};
  }
};

}  // namespace

MISFIT_EFFECT(overflow_into, OverflowInto)
