#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Gear play: what follows the displacement (z) moves only once the displacement has crossed the clearance. Added is the
/// change of the force of the spring between both that the play makes; the linear part stays in the model. z follows within backlash_tau, a
/// numerical time, instead of in no time.
struct Backlash {
  static constexpr const char* formula =
      "F = play_stiffness (z - displacement), z' = (what of displacement - z lies beyond +-play)/backlash_tau";
  static constexpr const char* symbols =
      "play_stiffness [port/displacement], play half of the clearance [displacement], backlash_tau [s], z the side that follows "
      "[displacement], displacement of the "
      "side that drives [any]";
  static constexpr const char* valid =
      "backlash_tau short against the motion: z then lags by backlash_tau times its rate; friction holds z inside the clearance";
  static constexpr const char* size =
      "a gear with 0.5 deg of clearance (play = 0.25 deg) and 100 N m/rad: up to 0.44 N m, always against the last direction";
  static constexpr const char* source =
      "Tao and Kokotovic, Adaptive Control of Systems with Actuator and Sensor Nonlinearities (1996): play operator; here relaxed over "
      "backlash_tau";
  static constexpr const char* excludes = "impact, a free side that drifts inside the clearance, wear";

  enum Quantity { displacement };
  static constexpr Role quantities[] = {{.name = "displacement", .unit = "*", .input_too = true}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { play_stiffness, play, backlash_tau };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "play_stiffness",
       .unit = "{port}/{displacement}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 1.0,
       .doc = "force per displacement that z lies behind"},
      {.name = "play",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "{displacement}",
       .lower = 1e-12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "half of the clearance",
       .scan = {.from = 0.03, .to = 0.3, .count = 4, .over = "+-displacement"}},
      {.name = "backlash_tau",
       .kind = CoefficientKind::shape,
       .value = 0.01,
       .unit = "s",
       .lower = 1e-9,
       .upper = 1e9,
       .scale = 0.01,
       .doc = "time in which z is carried along",
       .fixed = true,
       .scan = {.from = 2.0, .to = 2.0, .count = 1, .over = "step"}},
  };
  enum State { z };
  static constexpr OwnStateSpec states[] = {{.name = "z", .unit = "{displacement}"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    const T ahead = in.q[displacement] - in.z[z];
    F[port] = -in.c[play_stiffness] * ahead;
    drift[z] = beyond(ahead, in.c[play]) / in.c[backlash_tau];
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[backlash_tau]; }

  static std::vector<Example> examples() {
    return {{.quantities = {0.5},
             .coefficients = {10.0, 0.2, 0.05},
             .states = {0.1},
             .ports = {-4.0},
             .drifts = {4.0},
             .source = "ahead by 0.4, of which 0.2 beyond the play: 0.2/0.05"},
            {.quantities = {-1.0},
             .coefficients = {-3.0, 0.5, 0.1},
             .states = {-0.8},
             .t = 2.0,
             .ports = {-0.6},
             .drifts = {0.0},
             .source = "within the play z stands still: -3 x 0.2"}};
  }
};

}  // namespace

MISFIT_EFFECT(backlash, Backlash)
