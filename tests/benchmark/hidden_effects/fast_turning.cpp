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

  enum Quantity { lateral_rate };
  static constexpr Role quantities[] = {{.name = "lateral_rate", .unit = "rad/s"}};
  enum Port { pitching_moment };
  static constexpr Role ports[] = {{.name = "pitching_moment", .unit = "N m"}};
  enum Coefficient { turning };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "turning", .unit = "N m", .lower = -1e4, .upper = 1e4, .scale = 10.0, .doc = "size of the moment"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::tanh;
    F[pitching_moment] = in.c[turning] * tanh(T(in.q[lateral_rate] * in.q[lateral_rate]));
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.5}, .coefficients = {20.0}, .ports = {4.89837325}, .source = "20 tanh(1/4)"}};
  }
};

}  // namespace

MISFIT_EFFECT(fast_turning, FastTurning)
