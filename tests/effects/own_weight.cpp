#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Reads a constant that only one system has, and may act on two ports.
struct OwnWeight {
  static constexpr const char* formula = "F = share mass g on `port`, and the same on `also`";
  static constexpr const char* symbols = "share [-], mass [kg], g = 9.80665 m/s^2";
  static constexpr const char* valid = "always";
  static constexpr const char* size = "9.8 N for 1 kg";
  static constexpr const char* source = "made up for the tests";
  static constexpr const char* excludes = "everything else";
  static constexpr Role ports[] = {{"port", "*"}, {"also", "*", true}};
  static constexpr const char* constants[] = {"mass"};
  static constexpr CoefficientSpec coefficients[] = {
      {"share", CoefficientKind::strength, 0.0, "-", -2.0, 2.0, 0.5, "part of the weight that acts"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[0] = in.c[0] * (in.k[0] * 9.80665);
    F[1] = F[0];
  }

  static std::vector<Example> examples() {
    return {{{2.0}, {}, {0.5}, {}, 0.0, {9.80665, 9.80665}, {}, "half of 2 kg"},
            {{1.0}, {}, {-1.0}, {}, 0.0, {-9.80665, -9.80665}, {}, "upwards"}};
  }
};

}  // namespace

MISFIT_EFFECT(own_weight, OwnWeight)
