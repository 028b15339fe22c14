#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sensor with memory that reads the predicted output: own state on a sensor port.
struct SensorLag {
  static constexpr const char* formula = "y = h + share (z - h), z' = (h - z)/tau";
  static constexpr const char* symbols = "h predicted reading, z lagged reading [output], share of the lagged part [-], tau [s]";
  static constexpr const char* valid = "first-order sensors";
  static constexpr const char* size = "share = 1: the whole reading lags by tau";
  static constexpr const char* source = "first-order filter";
  static constexpr const char* excludes = "pure delay";
  static constexpr Role quantities[] = {{"reading", "*"}};
  static constexpr Role ports[] = {{"output", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"share", CoefficientKind::strength, 0.0, "-", -2.0, 2.0, 0.1, "lagged part of the reading"},
      {"sensor_tau", CoefficientKind::shape, 0.05, "s", 1e-4, 10.0, 0.05, "time constant"}};
  static constexpr OwnStateSpec states[] = {{"z", "{output}", 0.0}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* y, T* drift) {
    y[0] = in.c[0] * (in.z[0] - in.q[0]);
    drift[0] = (in.q[0] - in.z[0]) / in.c[1];
  }

  static std::vector<Example> examples() {
    return {{{}, {2.0}, {0.5, 0.1}, {1.0}, 0.0, {-0.5}, {10.0}, "0.5 (1 - 2); (2 - 1)/0.1"},
            {{}, {-1.0}, {1.0, 0.5}, {1.0}, 0.0, {2.0}, {-4.0}, "by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(sensor_lag, SensorLag)
