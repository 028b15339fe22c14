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
  static constexpr Role quantities[] = {{"rate", "*"}, {"displacement", "{rate} s"}, {"inertia", "*", true}};
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"hysteresis", CoefficientKind::strength, 0.0, "{port}", -1e6, 1e6, 1.0, "limit of the force"},
      scanned({"yield", CoefficientKind::shape, 0.1, "{displacement}", 1e-9, 1e6, 0.1, "motion over which the force comes to its limit"},
              {0.06, 0.5, 4, "|displacement|"}),
      held({"loop", CoefficientKind::shape, 0.5, "-", 0.5, 1.0, 0.1, "0.5: turning back starts with the slope of the first loading"}),
      held(scanned({"hysteresis_width", CoefficientKind::shape, 0.05, "{rate}", 1e-9, 1e6, 0.05,
                    "rounding of the rate about 0: a fiftieth of the largest rate"},
                   {0.02, 0.02, 1, "|rate|"}))};
  static constexpr OwnStateSpec states[] = {{"z", "-", 0.0}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    const T &rate = in.q[0], &z = in.z[0], &loop = in.c[2];
    const T bend = value_of(z) < 0.0 ? T(-z) : z;
    F[0] = -in.c[0] * z;
    drift[0] = (rate - loop * smooth_abs(rate, in.c[3]) * bend * z - (1.0 - loop) * rate * z * z) / in.c[1];
  }

  /// Of the elastic part, sqrt(force/(yield inertia)), and of z at the largest rate, of which the width is taken to be a fiftieth:
  /// |dz'/dz| at |z| = 1 is 2 |rate|/yield for every loop.
  static double fastest_rate(const Reads<double, double>& in) {
    constexpr double rates_per_width = 2.0 * 50.0;
    const double inertia = in.q[2] > 0.0 ? in.q[2] : 1.0;
    return std::max(std::sqrt(std::abs(in.c[0]) / (in.c[1] * inertia)), rates_per_width * in.c[3] / in.c[1]);
  }

  static std::vector<Example> examples() {
    return {
        {{}, {2.0, 0.3, 4.0}, {10.0, 0.5, 0.6, 0.01}, {0.5}, 0.0, {-5.0}, {3.0}, "2 (1 - 0.6 x 0.25 - 0.4 x 0.25)/0.5"},
        {{}, {-1.0, -0.2, 0.0}, {-3.0, 0.25, 0.5, 0.01}, {0.8}, 1.0, {2.4}, {-4.0}, "turning back: (-1 - 0.5 x 0.64 + 0.5 x 0.64)/0.25"}};
  }
};

}  // namespace

MISFIT_EFFECT(hysteresis, Hysteresis)
