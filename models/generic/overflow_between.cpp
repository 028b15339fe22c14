#include <array>

#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// What one level spills above an edge is lost there and arrives, in part, at another one: an upper tank that runs over into the lower.
/// Both halves are one cause with one edge. By itself overflow_into has the second half alone, which makes water of nothing: beside it the
/// filter finds no maximum, or another edge.
struct OverflowBetween {
  static constexpr const char* formula = "F_from = -spilled (level - spill_edge), F_to = -caught_share F_from, above the edge; else 0";
  static constexpr const char* symbols =
      "spilled [1/s], spill_edge [level], caught_share of what is spilled that arrives [-], level that spills [any]; port is "
      "the rate of change of that level, to_port that of the one where it arrives";
  static constexpr const char* valid = "arrives at once; outflow in proportion to the height above the edge (overflow)";
  static constexpr const char* size =
      "spilled = 0.1 /s and an inflow of 0.02 V/s too much: 0.2 V above the edge; with caught_share = 0.4 the lower tank gets 0.008 V/s";
  static constexpr const char* source =
      "cascaded tanks: Schoukens, Mattsson, Wigren, Noel (2016), section 2: the upper tank overflows in part into the lower one";
  static constexpr const char* excludes = "delay on the way, the weir power 1.5; where nothing is caught: overflow";

  enum Quantity { level };
  /// Neither heat nor a concentration, a speed or a current spills.
  static constexpr std::array no_levels{"K", "kg/m^3", "mol/m^3", "m/s", "rad/s", "A"};
  static constexpr Role quantities[] = {{.name = "level", .unit = "*", .never = no_levels}};
  enum Port { port, to_port };
  static constexpr Role ports[] = {{.name = "port", .unit = "{level}/s"}, {.name = "to_port", .unit = "{level}/s"}};
  enum Coefficient { spilled, spill_edge, caught_share };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "spilled", .unit = "{port}/{level}", .lower = 0.0, .upper = 1e15, .scale = 0.1, .doc = "outflow per level above the edge"},
      {.name = "spill_edge",
       .kind = CoefficientKind::shape,
       .value = 1.0,
       .unit = "{level}",
       .lower = -1e12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "level of the edge",
       .scan = {.from = 0.5, .to = 0.98, .count = 7, .over = "level"}},
      {.name = "caught_share",
       .kind = CoefficientKind::shape,
       .value = 0.5,
       .unit = "-",
       .lower = 0.05,  // less is an overflow to nowhere, which has a parameter less
       .upper = 20.0,  // of tanks of different areas more than 1
       .scale = 0.1,
       .doc = "of what is spilled, what arrives",
       .scan = {.from = 0.2, .to = 1.0, .count = 3}},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T lost = in.c[spilled] * above(T(in.q[level] - in.c[spill_edge]));
    F[port] = -lost;
    F[to_port] = in.c[caught_share] * lost;
  }

  /// Asked at the start of a run: the level may come to the edge later.
  static double fastest_rate(const Reads<double, double>& in) { return in.c[spilled]; }

  static std::vector<Example> examples() {
    return {
        {.quantities = {10.5}, .coefficients = {0.4, 10.0, 0.25}, .ports = {-0.2, 0.05}, .source = "by hand: 0.4 x 0.5, a quarter of it"},
        {.quantities = {-1.0}, .coefficients = {2.0, -1.5, 0.5}, .ports = {-1.0, 0.5}, .source = "by hand: 2 x 0.5, half of it"},
        {.quantities = {9.0}, .coefficients = {0.4, 10.0, 0.5}, .ports = {0.0, 0.0}, .source = "not full"}};
  }
};

}  // namespace

MISFIT_EFFECT(overflow_between, OverflowBetween)
