#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A force that answers to a quantity with delay: z follows x with the time constant tau, and the force is what z lags behind.
struct Lag {
  static constexpr const char* formula = "F = k (z - x), z' = (x - z)/tau";
  static constexpr const char* symbols = "x the level [any], z lagged level [level], k [port/level], tau time constant [s]";
  static constexpr const char* valid = "one time constant; force = 0 in equilibrium, whatever k";
  static constexpr const char* size =
      "for slow motion F = -k tau x': a lag of 0.1 s with k = 100 N m/rad looks like a damping of 10 N m s/rad";
  static constexpr const char* source = "first-order lag (Tobak and Schiff, NASA TR R-456, 1976: memory of aerodynamic moments)";
  static constexpr const char* excludes = "pure delay, several time constants";

  enum Quantity { level };
  static constexpr Role quantities[] = {{.name = "level", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { lag_stiffness, tau };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "lag_stiffness",
       .unit = "{port}/{level}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 1.0,
       .doc = "force per level that z lags behind"},
      {.name = "tau",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "s",
       .lower = 1e-9,
       .upper = 1e9,
       .scale = 0.1,
       .doc = "time constant",
       .scan = {.from = 1.0, .to = 20.0, .count = 4, .over = "step"}},
  };
  enum State { z };
  static constexpr OwnStateSpec states[] = {{.name = "z", .unit = "{level}"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    const T behind = in.z[z] - in.q[level];
    F[port] = in.c[lag_stiffness] * behind;
    drift[z] = -behind / in.c[tau];
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[tau]; }

  static std::vector<Example> examples() {
    return {{.quantities = {0.3},
             .coefficients = {100.0, 0.2},
             .states = {0.5},
             .ports = {20.0},
             .drifts = {-1.0},
             .source = "by hand: 100 x 0.2; (0.3 - 0.5)/0.2"},
            {.quantities = {2.0},
             .coefficients = {-3.0, 0.5},
             .states = {1.0},
             .t = 7.0,
             .ports = {3.0},
             .drifts = {2.0},
             .source = "by hand: -3 x -1; (2 - 1)/0.5"}};
  }
};

}  // namespace

MISFIT_EFFECT(lag, Lag)
