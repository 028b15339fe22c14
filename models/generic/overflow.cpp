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

  enum Quantity { level };
  static constexpr Role quantities[] = {{.name = "level", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "{level}/s"}};
  enum Coefficient { spill, threshold };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "spill",
       .unit = "{port}/{level}",
       .lower = 0.0,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "outflow per level above the threshold"},
      {.name = "threshold",
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
    F[port] = -in.c[spill] * above(T(in.q[level] - in.c[threshold]));
  }

  /// Asked at the start of a run: the level may come to the edge later.
  static double fastest_rate(const Reads<double, double>& in) { return in.c[spill]; }

  static std::vector<Example> examples() {
    return {{.quantities = {10.5}, .coefficients = {0.4, 10.0}, .ports = {-0.2}, .source = "by hand: 0.4 x 0.5"},
            {.quantities = {-1.0}, .coefficients = {2.0, -1.5}, .ports = {-1.0}, .source = "by hand: 2 x 0.5"},
            {.quantities = {9.0}, .coefficients = {0.4, 10.0}, .ports = {0.0}, .source = "not full"}};
  }
};

}  // namespace

MISFIT_EFFECT(overflow, Overflow)
