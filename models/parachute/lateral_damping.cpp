#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Damping across the plane of the tilt that differs from the damping in it: what `pitch_damping` applies to both is changed for one.
struct LateralDamping {
  static constexpr const char* formula = "M_lateral = q S D (D/2V) C_lateral omega_lateral sin^4(eta)/(sin^4(eta) + 0.02^4)";
  static constexpr const char* symbols =
      "q [Pa], S [m^2], D [m], V wind speed [m/s], omega_lateral rotation rate across the plane of the tilt [rad/s], C_lateral [-]";
  static constexpr const char* valid = "quasi-steady; adds to C_mq of pitch_damping; at tilts near 0 the two planes cannot differ";
  static constexpr const char* size = "-0.25 at 1 rad/s: -12.8 N m at 736 Pa, 35.1 m/s, D = 1.58 m";
  static constexpr const char* source = "Tobak and Schiff, NASA TR R-456 (1976): damping in coning motion is a characteristic of its own";
  static constexpr const char* excludes = "memory of the wake (aerodynamic_lag)";
  static constexpr Role quantities[] = {
      {"dynamic_pressure", "Pa"}, {"wind_speed", "m/s", false, true}, {"lateral_rate", "rad/s"}, {"eta", "rad"}};
  static constexpr Role ports[] = {{"lateral_moment", "N m"}};
  static constexpr const char* constants[] = {"S", "D"};
  static constexpr CoefficientSpec coefficients[] = {{"C_lateral", CoefficientKind::strength, 0.0, "-", -50.0, 50.0, 0.25,
                                                      "lateral damping coefficient besides C_mq; negative takes energy out"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::sin;
    constexpr double covered = 0.02;  // sine of the tilt below which the plane of the tilt means nothing (strut_wake)
    const T sine = sin(in.q[3]);
    const T fourth = sine * sine * sine * sine;
    const T open = fourth / (fourth + covered * covered * covered * covered);
    F[0] = in.q[0] * (in.k[0] * in.k[1] * in.k[1]) / (2.0 * in.q[1]) * in.c[0] * in.q[2] * open;
  }

  static std::vector<Example> examples() {
    return {
        {{1.9554, 1.5816}, {736.0, 35.1, 1.0, 1.57079633}, {-0.25}, {}, 0.0, {-12.8206356}, {}, "12.8206377/(1 + 0.02^4)"},
        {{2.0, 3.0}, {100.0, 30.0, -2.0, 0.020001334}, {0.4}, {}, 0.0, {-12.0}, {}, "100 x 2 x 9/60 x 0.4 x -2, half open at sin = 0.02"}};
  }
};

}  // namespace

MISFIT_EFFECT(lateral_damping, LateralDamping)
