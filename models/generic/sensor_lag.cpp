#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor with inertia: its reading follows what it measures.
struct SensorLag {
  static constexpr const char* formula = "y = h + share (z - h), z' = (h - z)/sensor_tau";
  static constexpr const char* symbols = "h predicted reading, z lagged reading [output], share of the lagged part [-], sensor_tau [s]";
  static constexpr const char* valid = "first-order sensors: thermometers, filters";
  static constexpr const char* size = "share = 1: the whole reading lags by sensor_tau";
  static constexpr const char* source = "first-order filter: Doebelin, Measurement Systems, section 3.3";
  static constexpr const char* excludes = "pure delay (sensor_delay), filters of higher order";
  static constexpr Role quantities[] = {{"reading", "*"}};
  static constexpr Role ports[] = {{"output", "{reading}"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"share", CoefficientKind::strength, 0.0, "-", -2.0, 2.0, 0.1, "lagged part of the reading"},
      scanned({"sensor_tau", CoefficientKind::shape, 0.05, "s", 1e-4, 1e5, 0.05, "time constant"}, {1.0, 20.0, 4, "step"})};
  static constexpr OwnStateSpec states[] = {{"z", "{output}", 0.0}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y, T* drift) {
    const T ahead = in.q[0] - in.z[0];
    y[0] = -in.c[0] * ahead;
    drift[0] = ahead / in.c[1];
  }

  static double fastest_rate(const Reads<double, double>& in) { return 1.0 / in.c[1]; }

  static std::vector<Example> examples() {
    return {{{}, {2.0}, {0.5, 0.1}, {1.0}, 0.0, {-0.5}, {10.0}, "0.5 (1 - 2); (2 - 1)/0.1"},
            {{}, {-1.0}, {1.0, 0.5}, {1.0}, 0.0, {2.0}, {-4.0}, "by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_lag, SensorLag)
