#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A force that grows slowly and evenly: a zero that wanders, something that warms up.
struct Drift {
  static constexpr const char* formula = "F = drift (t - drift_origin)";
  static constexpr const char* symbols = "drift [port/s], t time of the recording [s], drift_origin where it is 0 [s]";
  static constexpr const char* valid = "a drift that is even over the recording";
  static constexpr const char* size = "1 N m over a minute: 0.017 N m/s";
  static constexpr const char* source = "first term of the Taylor series in time";
  static constexpr const char* excludes = "wandering in both directions, drift of a coefficient (give that coefficient a curve)";
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"drift", CoefficientKind::strength, 0.0, "{port}/s", -1e6, 1e6, 0.01, "growth of the force"},
      held({"drift_origin", CoefficientKind::shape, 0.0, "s", -1e9, 1e9, 1.0, "time at which it is 0"})};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[0] = in.c[0] * (in.t - in.c[1]);
  }

  static std::vector<Example> examples() {
    return {{{}, {}, {0.5, 2.0}, {}, 10.0, {4.0}, {}, "by hand: 0.5 x 8"},
            {{}, {}, {-0.1, -5.0}, {}, 15.0, {-2.0}, {}, "by hand: -0.1 x 20"}};
  }
};

}  // namespace

MISFIT_EFFECT(drift, Drift)
