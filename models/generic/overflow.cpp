#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A level that spills above a threshold, to nowhere: a tank that is full. The steeper the spill, the more it is a lid: spill -> large
/// holds the level at the threshold and all that flows in is lost. Where the spill arrives elsewhere, overflow_into adds it there.
struct Overflow {
  static constexpr const char* formula = "F = -spill (level - threshold) above the threshold, else 0";
  static constexpr const char* symbols = "spill [1/s], threshold [level], level [any]; the port is the rate of change of the level";
  static constexpr const char* valid =
      "a wide edge: outflow in proportion to the height above it; the derivative at the corner is that of the side the level is on";
  static constexpr const char* size = "spill = 0.1 /s and an inflow of 0.02 V/s too much: 0.2 V above the edge";
  static constexpr const char* source =
      "first-order form of the weir (Bazin: q ~ h^1.5); cascaded tanks: Schoukens, Mattsson, Wigren, Noel (2016), section 2";
  static constexpr const char* excludes = "the weir power 1.5, where the water goes (overflow_into)";
  static constexpr Role quantities[] = {{"level", "*"}};
  static constexpr Role ports[] = {{"port", "{level}/s"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"spill", CoefficientKind::strength, 0.0, "{port}/{level}", 0.0, 100.0, 0.1, "outflow per level above the threshold"},
      scanned({"threshold", CoefficientKind::shape, 1.0, "{level}", -1e9, 1e9, 0.1, "level of the edge"}, {0.5, 0.98, 7, "level"})};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[0] = -in.c[0] * above(T(in.q[0] - in.c[1]));
  }

  /// Asked at the start of a run: the level may come to the edge later.
  static double fastest_rate(const Reads<double, double>& in) { return in.c[0]; }

  static std::vector<Example> examples() {
    return {{{}, {10.5}, {0.4, 10.0}, {}, 0.0, {-0.2}, {}, "by hand: 0.4 x 0.5"},
            {{}, {-1.0}, {2.0, -1.5}, {}, 0.0, {-1.0}, {}, "by hand: 2 x 0.5"},
            {{}, {9.0}, {0.4, 10.0}, {}, 0.0, {0.0}, {}, "not full"}};
  }
};

}  // namespace

MISFIT_EFFECT(overflow, Overflow)
