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

  enum Quantity { eta };
  static constexpr Role quantities[] = {{.name = "eta", .unit = "rad"}};
  enum Port { dynamic_pressure };
  static constexpr Role ports[] = {{.name = "dynamic_pressure", .unit = "Pa"}};
  enum Coefficient { blockage, blockage_tau };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "blockage", .unit = "Pa", .lower = -1e4, .upper = 1e4, .scale = 100.0, .doc = "pressure lost at z = 1"},
      {.name = "blockage_tau",
       .kind = CoefficientKind::shape,
       .value = 0.5,
       .unit = "s",
       .lower = 1e-3,
       .upper = 100.0,
       .scale = 0.5,
       .doc = "time constant",
       .scan = {.from = 0.1, .to = 2.5, .count = 4}},
  };
  enum State { z };
  static constexpr OwnStateSpec states[] = {{.name = "z", .unit = "-"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P, T* drift) {
    P[dynamic_pressure] = -in.c[blockage] * in.z[z] * in.z[z];
    drift[z] = (in.q[eta] - in.z[z]) / in.c[blockage_tau];
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[blockage_tau]; }

  static std::vector<Example> examples() {
    return {{.quantities = {0.4},
             .coefficients = {50.0, 0.5},
             .states = {0.2},
             .ports = {-2.0},
             .drifts = {0.4},
             .source = "50 x 0.04; 0.2/0.5"},
            {.quantities = {1.0}, .coefficients = {-3.0, 2.0}, .states = {2.0}, .ports = {12.0}, .drifts = {-0.5}, .source = "by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(pressure_memory, PressureMemory)
