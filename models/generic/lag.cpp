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
  static constexpr Role quantities[] = {{"level", "*"}};
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"lag_stiffness", CoefficientKind::strength, 0.0, "{port}/{level}", -1e6, 1e6, 1.0, "force per level that z lags behind"},
      scanned({"tau", CoefficientKind::shape, 0.1, "s", 1e-4, 1e4, 0.1, "time constant"}, {1.0, 20.0, 4, "step"})};
  static constexpr OwnStateSpec states[] = {{"z", "{level}", 0.0}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    const T behind = in.z[0] - in.q[0];
    F[0] = in.c[0] * behind;
    drift[0] = -behind / in.c[1];
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[1]; }

  static std::vector<Example> examples() {
    return {{{}, {0.3}, {100.0, 0.2}, {0.5}, 0.0, {20.0}, {-1.0}, "by hand: 100 x 0.2; (0.3 - 0.5)/0.2"},
            {{}, {2.0}, {-3.0, 0.5}, {1.0}, 7.0, {3.0}, {2.0}, "by hand: -3 x -1; (2 - 1)/0.5"}};
  }
};

}  // namespace

MISFIT_EFFECT(lag, Lag)
