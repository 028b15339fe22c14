#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Moment proportional to the rotation rate. Where the system has the felt wind in alpha_T the coefficient is C_mq; in the paper's form
/// (lib/misfit/README.md, [1], Eq. 8, alpha_T the state itself) the same formula carries the paper's C_m_alphadot = C_mq + (2 R_cp/D)
/// C_m_alpha cos(alpha_T).
struct PitchDamping {
  static constexpr const char* formula = "M = q S D (D/2V) C_mq(alpha_T) omega";
  static constexpr const char* symbols = "q [Pa], S [m^2], D [m], V wind speed [m/s], omega rotation rate of the axis [rad/s], C_mq [-]";
  static constexpr const char* valid = "quasi-steady: omega D/V << 1";
  static constexpr const char* size = "C_mq = -0.25 at 1 rad/s: -12.8 N m at 736 Pa, 35.1 m/s, D = 1.58 m";
  static constexpr const char* source = "paper Eq. 8; lib/misfit/README.md (10), (13)";
  static constexpr const char* excludes = "memory of the wake (aerodynamic lag)";
  static constexpr Role quantities[] = {
      {"dynamic_pressure", "Pa"}, {"wind_speed", "m/s", false, true}, {"pitch_rate", "rad/s"}, {"lateral_rate", "rad/s", true}};
  static constexpr Role ports[] = {{"pitching_moment", "N m"}, {"lateral_moment", "N m", true}};
  static constexpr const char* constants[] = {"S", "D"};
  static constexpr CoefficientSpec coefficients[] = {{"C_mq", CoefficientKind::strength, 0.0, "-", -50.0, 50.0, 0.25,
                                                      "pitch damping coefficient; negative takes energy out", Parity::even, "alpha_T"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T moment = in.q[0] * (in.k[0] * in.k[1] * in.k[1]) / (2.0 * in.q[1]) * in.c[0];
    F[0] = moment * in.q[2];
    F[1] = moment * in.q[3];
  }

  static std::vector<Example> examples() {
    return {{{1.9554, 1.5816}, {736.0, 35.1, 1.0, 0.0}, {-0.25}, {}, 0.0, {-12.820638, 0.0}, {}, "2276.1982 x 1.5816/70.2 x -0.25"},
            {{2.0, 3.0}, {100.0, 30.0, 0.5, -2.0}, {0.4}, {}, 0.0, {6.0, -24.0}, {}, "by hand: 100 x 2 x 9/60 x 0.4 = 12; x 0.5, x -2"}};
  }
};

}  // namespace

MISFIT_EFFECT(pitch_damping, PitchDamping)
