#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Static moment and damping as polynomials: what tests/benchmark/text_models/planar_text.toml says in words.
struct PolynomialMoment {
  static constexpr const char* formula = "M = q S D [(a0 + a2 alpha_T^2 + a4 alpha_T^4) (v x n) + (D/2V) (d0 + d2 alpha_T^2) omega]";
  static constexpr const char* symbols = "q [Pa], S [m^2], D [m], V [m/s], omega [rad/s], a [-], d [-]";
  static constexpr const char* valid = "for timing";
  static constexpr const char* size = "as static_moment and pitch_damping";
  static constexpr const char* source = "paper Eq. 8 with polynomials";
  static constexpr const char* excludes = "everything else";
  static constexpr Role quantities[] = {{"dynamic_pressure", "Pa"},
                                        {"wind_speed", "m/s", false, true},
                                        {"wind_cross_axis", "-"},
                                        {"alpha_T", "rad"},
                                        {"pitch_rate", "rad/s"}};
  static constexpr Role ports[] = {{"pitching_moment", "N m"}};
  static constexpr const char* constants[] = {"S", "D"};
  static constexpr CoefficientSpec coefficients[] = {
      {"a0", CoefficientKind::strength, 0.1, "-", -50.0, 50.0, 0.1, "static moment"},
      {"a2", CoefficientKind::strength, -2.0, "-", -50.0, 50.0, 1.0, "static moment, square"},
      {"a4", CoefficientKind::strength, -1.0, "-", -50.0, 50.0, 1.0, "static moment, fourth power"},
      {"d0", CoefficientKind::strength, -0.2, "-", -50.0, 50.0, 0.1, "damping"},
      {"d2", CoefficientKind::strength, 0.1, "-", -50.0, 50.0, 0.1, "damping, square"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T square = in.q[3] * in.q[3];
    const T still = (in.c[0] + square * (in.c[1] + square * in.c[2])) * in.q[2];
    F[0] = in.q[0] * (in.k[0] * in.k[1]) * (still + (in.k[1] * 0.5) / in.q[1] * (in.c[3] + in.c[4] * square) * in.q[4]);
  }

  static std::vector<Example> examples() {
    return {{{2.0, 3.0},
             {100.0, 30.0, 0.5, 0.1, 2.0},
             {1.0, 2.0, 3.0, 4.0, 5.0},
             {},
             0.0,
             {600.0 * (0.5 * 1.0203 + 0.05 * 4.05 * 2.0)},
             {},
             "by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(polynomial_moment, PolynomialMoment)
