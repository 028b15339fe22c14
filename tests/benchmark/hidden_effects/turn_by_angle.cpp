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
  static constexpr Role quantities[] = {{"alpha_T", "rad"}, {"eta", "rad"}};
  static constexpr Role ports[] = {{"lateral_moment", "N m"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"twist", CoefficientKind::strength, 0.0, "N m", -1e4, 1e4, 10.0, "size of the moment"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::sin;
    constexpr double covered = 0.05, turns_per_rad = 45.0;  // 2 pi over 8 deg
    const T sine = sin(in.q[1]);
    F[0] = in.c[0] * sin(T(turns_per_rad * in.q[0])) * (sine * sine / (sine * sine + covered * covered));
  }

  static std::vector<Example> examples() {
    return {{{}, {0.034906585, 1.57079633}, {20.0}, {}, 0.0, {19.9501247}, {}, "2 deg: a quarter turn; 20/1.0025"}};
  }
};

}  // namespace

MISFIT_EFFECT(turn_by_angle, TurnByAngle)
