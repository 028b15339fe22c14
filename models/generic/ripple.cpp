#include <algorithm>
#include <cmath>
#include <numbers>

#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A force that recurs along the way: a motor's magnets that favour some angles over others (cogging), the teeth of a rack or a belt, the
/// pitch of a screw, a wheel out of round.
struct Ripple {
  static constexpr const char* formula = "F = cosine cos(2 pi displacement/spacing) + sine sin(2 pi displacement/spacing)";
  static constexpr const char* symbols =
      "cosine, sine amplitudes [port], spacing after which the force recurs [displacement], rate [any] of the displacement [any] (of which "
      "only the size is used)";
  static constexpr const char* valid = "one harmonic; over several spacings: over less than one and a half it is one of many curves";
  static constexpr const char* size = "cogging of a motor with permanent magnets: some per cent of its rated torque";
  static constexpr const char* source =
      "Fourier; Hanselman, Brushless Permanent Magnet Motor Design, 2nd ed. (2003), chapter 5: cogging torque recurs with the angle";
  static constexpr const char* excludes = "harmonics, a spacing that changes along the way, ripple that grows with the current";

  enum Quantity { rate, displacement };
  static constexpr Role quantities[] = {{.name = "rate", .unit = "*"}, {.name = "displacement", .unit = "{rate} s"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { cosine, sine, spacing };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "cosine", .unit = "{port}", .lower = -1e15, .upper = 1e15, .scale = 1.0, .doc = "amplitude in phase with the cosine"},
      {.name = "sine", .unit = "{port}", .lower = -1e15, .upper = 1e15, .scale = 1.0, .doc = "amplitude in phase with the sine"},
      {.name = "spacing",
       .kind = CoefficientKind::shape,
       .value = 1.0,
       .unit = "{displacement}",
       .lower = 1e-12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "way after which the force recurs",
       .scan = {.from = 2.0, .to = 1e4, .count = -1, .over = "displacement"}},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = wave(T(in.q[displacement] / in.c[spacing]), in.c[cosine], in.c[sine]);
  }

  /// Of the ripple at this speed, and of the oscillation in one of its hollows.
  static double fastest_rate(const Reads<double, double>& in, double response) {
    const double waves = 2.0 * std::numbers::pi / in.c[spacing];
    return std::max(waves * std::abs(in.q[rate]), std::sqrt(waves * std::hypot(in.c[cosine], in.c[sine]) * response));
  }

  static std::vector<Example> examples() {
    return {{.quantities = {2.0, 0.05}, .coefficients = {3.0, 5.0, 0.2}, .ports = {5.0}, .source = "a quarter of the spacing: the sine"},
            {.quantities = {-1.0, -0.25},
             .coefficients = {3.0, 5.0, 1.5},
             .t = 1.0,
             .ports = {-2.83012702},
             .source = "-60 deg: 3/2 - 5 x 0.866025404"}};
  }
};

}  // namespace

MISFIT_EFFECT(ripple, Ripple)
