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

  enum Quantity { dynamic_pressure, wind_speed, wind_cross_axis, alpha_T, pitch_rate };
  static constexpr Role quantities[] = {{.name = "dynamic_pressure", .unit = "Pa"},
                                        {.name = "wind_speed", .unit = "m/s", .positive = true},
                                        {.name = "wind_cross_axis", .unit = "-"},
                                        {.name = "alpha_T", .unit = "rad"},
                                        {.name = "pitch_rate", .unit = "rad/s"}};
  enum Port { pitching_moment };
  static constexpr Role ports[] = {{.name = "pitching_moment", .unit = "N m"}};
  enum Constant { S, D };
  static constexpr const char* constants[] = {"S", "D"};
  enum Coefficient { a0, a2, a4, d0, d2 };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "a0", .value = 0.1, .unit = "-", .lower = -50.0, .upper = 50.0, .scale = 0.1, .doc = "static moment"},
      {.name = "a2", .value = -2.0, .unit = "-", .lower = -50.0, .upper = 50.0, .scale = 1.0, .doc = "static moment, square"},
      {.name = "a4", .value = -1.0, .unit = "-", .lower = -50.0, .upper = 50.0, .scale = 1.0, .doc = "static moment, fourth power"},
      {.name = "d0", .value = -0.2, .unit = "-", .lower = -50.0, .upper = 50.0, .scale = 0.1, .doc = "damping"},
      {.name = "d2", .value = 0.1, .unit = "-", .lower = -50.0, .upper = 50.0, .scale = 0.1, .doc = "damping, square"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T square = in.q[alpha_T] * in.q[alpha_T];
    const T still = (in.c[a0] + square * (in.c[a2] + square * in.c[a4])) * in.q[wind_cross_axis];
    F[pitching_moment] = in.q[dynamic_pressure] * (in.k[S] * in.k[D]) *
                         (still + (in.k[D] * 0.5) / in.q[wind_speed] * (in.c[d0] + in.c[d2] * square) * in.q[pitch_rate]);
  }

  static std::vector<Example> examples() {
    return {{.constants = {2.0, 3.0},
             .quantities = {100.0, 30.0, 0.5, 0.1, 2.0},
             .coefficients = {1.0, 2.0, 3.0, 4.0, 5.0},
             .ports = {600.0 * (0.5 * 1.0203 + 0.05 * 4.05 * 2.0)},
             .source = "by hand"}};
  }
};

}  // namespace

MISFIT_EFFECT(polynomial_moment, PolynomialMoment)
