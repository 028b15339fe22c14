#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A canopy that is not its own mirror image (gaps or lines with a twist) is pushed across the plane of its angle of attack: along n x (v x
/// n), regular at alpha_T = 0 as the static moment is.
struct SideMoment {
  static constexpr const char* formula = "M = q S D [C_n(alpha_T)/sin(alpha_T)] n x (v x n)";
  static constexpr const char* symbols =
      "q dynamic pressure [Pa], S area [m^2], D diameter [m], v wind direction, n axis; (v x n) in-plane and lateral [-]";
  static constexpr const char* valid = "quasi-steady; the same for every clock angle";
  static constexpr const char* size = "C_n = 0.002, a tenth of C_m off the trim: 4.6 N m at 736 Pa for D = 1.58 m, and steady coning";
  static constexpr const char* source = "Tobak and Schiff, NASA TR R-456 (1976): side moment of a body at angle of attack";
  static constexpr const char* excludes = "dependence on the rate of coning, spin of the canopy (magnus)";
  static constexpr Role quantities[] = {{"dynamic_pressure", "Pa"}, {"wind_cross_axis", "-"}, {"wind_cross_axis_lateral", "-"}};
  static constexpr Role ports[] = {{"pitching_moment", "N m"}, {"lateral_moment", "N m"}};
  static constexpr const char* constants[] = {"S", "D"};
  static constexpr CoefficientSpec coefficients[] = {{"C_n", CoefficientKind::strength, 0.0, "-", -10.0, 10.0, 0.005,
                                                      "side moment coefficient; positive turns the clock angle forward", Parity::odd,
                                                      "alpha_T", true}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T moment = in.q[0] * (in.k[0] * in.k[1]) * in.c[0];
    F[0] = -moment * in.q[2];
    F[1] = moment * in.q[1];
  }

  static std::vector<Example> examples() {
    // 2276.1982 N m per unit coefficient; C_n = 0.002 at 10 deg: over the sine 0.011517541.
    return {
        {{1.9554, 1.5816}, {736.0, 0.17364818, 0.0}, {0.002 / 0.17364818}, {}, 0.0, {0.0, 4.5523964}, {}, "736 x 1.9554 x 1.5816 x 0.002"},
        {{2.0, 1.5}, {100.0, 0.3, -0.1}, {0.5}, {}, 0.0, {15.0, 45.0}, {}, "by hand: 150, turned by a right angle"}};
  }
};

}  // namespace

MISFIT_EFFECT(side_moment, SideMoment)
