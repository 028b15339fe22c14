#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Gear play: what follows the displacement (z) moves only once the displacement has crossed the clearance. The force is what a spring
/// between both has less or more for it, so that the model keeps its linear part. z follows within backlash_tau, a numerical time, instead
/// of in no time.
struct Backlash {
  static constexpr const char* formula =
      "F = play_stiffness (z - displacement), z' = (what of displacement - z lies beyond +-play)/backlash_tau";
  static constexpr const char* symbols =
      "play_stiffness [port/displacement], play half of the clearance [displacement], backlash_tau [s], z the side that follows "
      "[displacement], displacement of the "
      "side that drives [any]";
  static constexpr const char* valid =
      "backlash_tau short against the motion: z then lags by backlash_tau times its rate; friction holds z inside the clearance";
  static constexpr const char* size = "a gear with 0.5 deg of play and 100 N m/rad: up to 0.4 N m, always against the last direction";
  static constexpr const char* source =
      "Tao and Kokotovic, Adaptive Control of Systems with Actuator and Sensor Nonlinearities (1996): play operator; here relaxed over "
      "backlash_tau";
  static constexpr const char* excludes = "impact, a free side that drifts inside the clearance, wear";
  static constexpr Role quantities[] = {{"displacement", "*"}};
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"play_stiffness", CoefficientKind::strength, 0.0, "{port}/{displacement}", -1e12, 1e12, 1.0,
       "force per displacement that z lies behind"},
      scanned({"play", CoefficientKind::shape, 0.1, "{displacement}", 1e-9, 1e6, 0.1, "half of the clearance"},
              {0.03, 0.3, 4, "|displacement|"}),
      held(scanned({"backlash_tau", CoefficientKind::shape, 0.01, "s", 1e-6, 1e4, 0.01, "time in which z is carried along"},
                   {2.0, 2.0, 1, "step"}))};
  static constexpr OwnStateSpec states[] = {{"z", "{displacement}", 0.0}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    const T ahead = in.q[0] - in.z[0];
    F[0] = -in.c[0] * ahead;
    drift[0] = beyond(ahead, in.c[1]) / in.c[2];
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[2]; }

  static std::vector<Example> examples() {
    return {{{}, {0.5}, {10.0, 0.2, 0.05}, {0.1}, 0.0, {-4.0}, {4.0}, "ahead by 0.4, of which 0.2 beyond the play: 0.2/0.05"},
            {{}, {-1.0}, {-3.0, 0.5, 0.1}, {-0.8}, 2.0, {-0.6}, {0.0}, "within the play z stands still: -3 x 0.2"}};
  }
};

}  // namespace

MISFIT_EFFECT(backlash, Backlash)
