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
  static constexpr Role quantities[] = {{"level", "*"}};
  static constexpr Role ports[] = {{"to_port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"caught", CoefficientKind::strength, 0.0, "{to_port}/{level}", 0.0, 1e6, 0.1, "inflow per level above the threshold"},
      scanned({"caught_threshold", CoefficientKind::shape, 1.0, "{level}", -1e9, 1e9, 0.1, "level of the edge"}, {0.5, 0.98, 7, "level"})};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[0] = in.c[0] * above(T(in.q[0] - in.c[1]));
  }

  static std::vector<Example> examples() {
    return {{{}, {10.5}, {0.4, 10.0}, {}, 0.0, {0.2}, {}, "by hand: 0.4 x 0.5"},
            {{}, {-1.0}, {2.0, -1.5}, {}, 0.0, {1.0}, {}, "by hand: 2 x 0.5"}};
  }
};

}  // namespace

MISFIT_EFFECT(overflow_into, OverflowInto)
