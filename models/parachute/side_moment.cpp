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

  enum Quantity { dynamic_pressure, wind_cross_axis, wind_cross_axis_lateral };
  static constexpr Role quantities[] = {{.name = "dynamic_pressure", .unit = "Pa"},
                                        {.name = "wind_cross_axis", .unit = "-"},
                                        {.name = "wind_cross_axis_lateral", .unit = "-"}};
  enum Port { pitching_moment, lateral_moment };
  static constexpr Role ports[] = {{.name = "pitching_moment", .unit = "N m"}, {.name = "lateral_moment", .unit = "N m"}};
  enum Constant { S, D };
  static constexpr const char* constants[] = {"S", "D"};
  enum Coefficient { C_n };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "C_n",
       .unit = "-",
       .lower = -10.0,
       .upper = 10.0,
       .scale = 0.005,
       .doc = "side moment coefficient; positive turns the clock angle forward",
       .parity = Parity::odd,
       .curve_of = "alpha_T",
       .over_sine = true},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T moment = in.q[dynamic_pressure] * (in.k[S] * in.k[D]) * in.c[C_n];
    F[pitching_moment] = -moment * in.q[wind_cross_axis_lateral];
    F[lateral_moment] = moment * in.q[wind_cross_axis];
  }

  static std::vector<Example> examples() {
    // 2276.1982 N m per unit coefficient; C_n = 0.002 at 10 deg: over the sine 0.011517541.
    return {{.constants = {1.9554, 1.5816},
             .quantities = {736.0, 0.17364818, 0.0},
             .coefficients = {0.002 / 0.17364818},
             .ports = {0.0, 4.5523964},
             .source = "736 x 1.9554 x 1.5816 x 0.002"},
            {.constants = {2.0, 1.5},
             .quantities = {100.0, 0.3, -0.1},
             .coefficients = {0.5},
             .ports = {15.0, 45.0},
             .source = "by hand: 150, turned by a right angle"}};
  }
};

}  // namespace

MISFIT_EFFECT(side_moment, SideMoment)
