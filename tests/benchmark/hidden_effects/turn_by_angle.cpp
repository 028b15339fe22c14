#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A sideways moment that changes its sign with the angle of attack: side_moment, a number, does not.
struct TurnByAngle {
  static constexpr const char* formula = "M_lateral = twist sin(2 pi alpha_T/8 deg) sin^2(eta)/(sin^2(eta) + 0.05^2)";
  static constexpr const char* symbols = "twist [N m], alpha_T, eta [rad]";
  static constexpr const char* valid = "simulation";
  static constexpr const char* size = "some N m";
  static constexpr const char* source = "made up for the bench";
  static constexpr const char* excludes = "everything else";

  enum Quantity { alpha_T, eta };
  static constexpr Role quantities[] = {{.name = "alpha_T", .unit = "rad"}, {.name = "eta", .unit = "rad"}};
  enum Port { lateral_moment };
  static constexpr Role ports[] = {{.name = "lateral_moment", .unit = "N m"}};
  enum Coefficient { twist };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "twist", .unit = "N m", .lower = -1e4, .upper = 1e4, .scale = 10.0, .doc = "size of the moment"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::sin;
    constexpr double covered = 0.05, turns_per_rad = 45.0;  // 2 pi over 8 deg
    const T sine = sin(in.q[eta]);
    F[lateral_moment] = in.c[twist] * sin(T(turns_per_rad * in.q[alpha_T])) * (sine * sine / (sine * sine + covered * covered));
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.034906585, 1.57079633},
             .coefficients = {20.0},
             .ports = {19.9501247},
             .source = "2 deg: a quarter turn; 20/1.0025"}};
  }
};

}  // namespace

MISFIT_EFFECT(turn_by_angle, TurnByAngle)
