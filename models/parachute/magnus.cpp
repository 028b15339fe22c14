#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A canopy that spins steadily moves across the air: Magnus force n x n', at right angles to the motion, and of the same form the
/// gyroscopic moment of its spin. It does no work. The part with the wind V instead of n' is a side moment (side_moment).
struct Magnus {
  static constexpr const char* formula = "M_in-plane = -q S D (D/2V) C_spin omega_lateral, M_lateral = q S D (D/2V) C_spin omega_in-plane";
  static constexpr const char* symbols =
      "q [Pa], S [m^2], D [m], V wind speed [m/s], omega rotation rates [rad/s], C_spin [-] proportional to the spin";
  static constexpr const char* valid = "spin that is steady over the recording";
  static constexpr const char* size = "0.05 at 1 rad/s: 2.6 N m at 736 Pa, 35.1 m/s, D = 1.58 m; the plane of the swing turns slowly";
  static constexpr const char* source = "Magnus force of a spinning body; gyroscope: Goldstein, Classical Mechanics, chapter 5";
  static constexpr const char* excludes = "spin that changes, the swivel's own inertia";
  static constexpr Role quantities[] = {
      {"dynamic_pressure", "Pa"}, {"wind_speed", "m/s", false, true}, {"pitch_rate", "rad/s"}, {"lateral_rate", "rad/s"}};
  static constexpr Role ports[] = {{"pitching_moment", "N m"}, {"lateral_moment", "N m"}};
  static constexpr const char* constants[] = {"S", "D"};
  static constexpr CoefficientSpec coefficients[] = {
      {"C_spin", CoefficientKind::strength, 0.0, "-", -50.0, 50.0, 0.05, "coefficient of the moment across the motion"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T moment = in.q[0] * (in.k[0] * in.k[1] * in.k[1]) / (2.0 * in.q[1]) * in.c[0];
    F[0] = -moment * in.q[3];
    F[1] = moment * in.q[2];
  }

  static std::vector<Example> examples() {
    return {{{1.9554, 1.5816}, {736.0, 35.1, 1.0, 0.0}, {0.05}, {}, 0.0, {0.0, 2.56412764}, {}, "2276.1982 x 1.5816/70.2 x 0.05"},
            {{2.0, 3.0}, {100.0, 30.0, 0.5, -2.0}, {0.4}, {}, 0.0, {24.0, 6.0}, {}, "by hand: 12 x 2, 12 x 0.5"}};
  }
};

}  // namespace

MISFIT_EFFECT(magnus, Magnus)
