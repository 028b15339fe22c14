#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Own state on a quantity port: blockage of the tunnel that follows the tilt with delay.
struct PressureMemory {
  static constexpr const char* formula = "q = qbar - blockage z^2, z' = (eta - z)/tau";
  static constexpr const char* symbols = "blockage [Pa], z lagged tilt [-], eta tilt [rad], tau [s]";
  static constexpr const char* valid = "small tilts";
  static constexpr const char* size = "100 Pa at z = 0.2: 4 Pa";
  static constexpr const char* source = "made up for the tests";
  static constexpr const char* excludes = "everything else";
  static constexpr Role quantities[] = {{"eta", "rad"}};
  static constexpr Role ports[] = {{"dynamic_pressure", "Pa"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"blockage", CoefficientKind::strength, 0.0, "Pa", -1e4, 1e4, 100.0, "pressure lost at z = 1"},
      scanned({"blockage_tau", CoefficientKind::shape, 0.5, "s", 1e-3, 100.0, 0.5, "time constant"}, {0.1, 2.5, 4})};
  static constexpr OwnStateSpec states[] = {{"z", "-", 0.0}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P, T* drift) {
    P[0] = -in.c[0] * in.z[0] * in.z[0];
    drift[0] = (in.q[0] - in.z[0]) / in.c[1];
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[1]; }

  static std::vector<Example> examples() {
    return {{{}, {0.4}, {50.0, 0.5}, {0.2}, 0.0, {-2.0}, {0.4}, "50 x 0.04; 0.2/0.5"},
            {{}, {1.0}, {-3.0, 2.0}, {2.0}, 0.0, {12.0}, {-0.5}, "by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(pressure_memory, PressureMemory)
