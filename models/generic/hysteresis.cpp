#include <algorithm>

#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A restoring force with memory (Bouc and Wen): elastic at first, sliding once the motion has gone on by about `yield`; turning back it
/// starts elastic again. z is the force as a share of its limit.
struct Hysteresis {
  static constexpr const char* formula =
      "F = -hysteresis z, z' = (rate - loop |rate| |z| z - (1 - loop) rate z^2)/yield, |rate| rounded over hysteresis_width";
  static constexpr const char* symbols =
      "hysteresis limit of the force [port], yield [displacement], loop share that makes the loop [-], z [-], rate [any] of the "
      "displacement [any] (of "
      "which only the size is used)";
  static constexpr const char* valid =
      "loops that do not depend on the rate; 0.5 <= loop <= 1 (Erlicher and Point, Comptes Rendus Mecanique 332 (2004): elsewhere a cycle "
      "could give work)";
  static constexpr const char* size = "presliding of a bearing: its friction over some 0.1 deg";
  static constexpr const char* source =
      "Wen, Journal of the Engineering Mechanics Division ASCE 102 (1976), with n = 2 and A = 1; Ismail, Ikhouane, Rodellar (2009)";
  static constexpr const char* excludes = "slip that weakens, pinching, rate dependence";

  enum Quantity { rate, displacement };
  static constexpr Role quantities[] = {{.name = "rate", .unit = "*"}, {.name = "displacement", .unit = "{rate} s"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { hysteresis, yield, loop, hysteresis_width };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "hysteresis", .unit = "{port}", .lower = -1e15, .upper = 1e15, .scale = 1.0, .doc = "limit of the force"},
      {.name = "yield",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "{displacement}",
       .lower = 1e-12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "motion over which the force comes to its limit",
       .scan = {.from = 0.06, .to = 0.5, .count = 4, .over = "+-displacement"}},
      {.name = "loop",
       .kind = CoefficientKind::shape,
       .value = 0.5,
       .unit = "-",
       .lower = 0.5,
       .upper = 1.0,
       .scale = 0.1,
       .doc = "0.5: turning back starts with the slope of the first loading",
       .fixed = true},
      {.name = "hysteresis_width",
       .kind = CoefficientKind::shape,
       .value = 0.05,
       .unit = "{rate}",
       .lower = 1e-12,
       .upper = 1e12,
       .scale = 0.05,
       .doc = "rounding of the rate about 0: a fiftieth of the largest rate",
       .fixed = true,
       .scan = {.from = 0.02, .to = 0.02, .count = 1, .over = "|rate|"}},
  };
  enum State { z };
  static constexpr OwnStateSpec states[] = {{.name = "z", .unit = "-"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    const T &v = in.q[rate], &bend = in.z[z], &share = in.c[loop];
    const T magnitude = value_of(bend) < 0.0 ? T(-bend) : bend;
    F[port] = -in.c[hysteresis] * bend;
    drift[z] = (v - share * smooth_abs(v, in.c[hysteresis_width]) * magnitude * bend - (1.0 - share) * v * bend * bend) / in.c[yield];
  }

  /// Of the elastic part, sqrt(force/(yield inertia)), and of z at the largest rate, of which the width is taken to be a fiftieth:
  /// |dz'/dz| at |z| = 1 is 2 |rate|/yield for every loop.
  static double fastest_rate(const Reads<double, double>& in, double response) {
    constexpr double rates_per_width = 2.0 * 50.0;
    return std::max(std::sqrt(std::abs(in.c[hysteresis]) / in.c[yield] * response), rates_per_width * in.c[hysteresis_width] / in.c[yield]);
  }

  static std::vector<Example> examples() {
    return {{.quantities = {2.0, 0.3},
             .coefficients = {10.0, 0.5, 0.6, 0.01},
             .states = {0.5},
             .ports = {-5.0},
             .drifts = {3.0},
             .source = "2 (1 - 0.6 x 0.25 - 0.4 x 0.25)/0.5"},
            {.quantities = {-1.0, -0.2},
             .coefficients = {-3.0, 0.25, 0.5, 0.01},
             .states = {0.8},
             .t = 1.0,
             .ports = {2.4},
             .drifts = {-4.0},
             .source = "turning back: (-1 - 0.5 x 0.64 + 0.5 x 0.64)/0.25"}};
  }
};

}  // namespace

MISFIT_EFFECT(hysteresis, Hysteresis)
