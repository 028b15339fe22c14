#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A moment in the plane that sets in where the canopy turns fast, either way: even in the lateral rate.
struct FastTurning {
  static constexpr const char* formula = "M_in-plane = turning tanh((omega_lateral/(1 rad/s))^2)";
  static constexpr const char* symbols = "turning [N m], omega_lateral rotation rate across the plane [rad/s]";
  static constexpr const char* valid = "simulation";
  static constexpr const char* size = "some N m";
  static constexpr const char* source = "made up for the bench";
  static constexpr const char* excludes = "everything else";
  static constexpr Role quantities[] = {{"lateral_rate", "rad/s"}};
  static constexpr Role ports[] = {{"pitching_moment", "N m"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"turning", CoefficientKind::strength, 0.0, "N m", -1e4, 1e4, 10.0, "size of the moment"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::tanh;
    F[0] = in.c[0] * tanh(T(in.q[0] * in.q[0]));
  }

  static std::vector<Example> examples() { return {{{}, {0.5}, {20.0}, {}, 0.0, {4.89837325}, {}, "20 tanh(1/4)"}}; }
};

}  // namespace

MISFIT_EFFECT(fast_turning, FastTurning)
