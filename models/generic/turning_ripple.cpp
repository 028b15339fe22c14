#include <cmath>
#include <numbers>

#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A force that recurs with the angle turned, or the way gone, where only the speed is a state: cogging or an unbalance of a motor whose
/// speed is measured, the pulses of a pump. The way is counted from where each recording begins.
struct TurningRipple {
  static constexpr const char* formula = "F = cosine cos(2 pi turned/spacing) + sine sin(2 pi turned/spacing), turned' = speed";
  static constexpr const char* symbols =
      "cosine, sine amplitudes [port], spacing after which the force recurs [speed s], speed [any], turned since the start [speed s]";
  static constexpr const char* valid =
      "one harmonic; one recording, or several that begin at the same angle; a speed known well enough that the way is, to a part of the "
      "spacing";
  static constexpr const char* size = "cogging of a motor with permanent magnets: some per cent of its rated torque";
  static constexpr const char* source =
      "Fourier; Hanselman, Brushless Permanent Magnet Motor Design, 2nd ed. (2003), chapter 5: cogging torque recurs with the angle";
  static constexpr const char* excludes = "harmonics, ripple that grows with the current or with the square of the speed";

  enum Quantity { speed };
  static constexpr Role quantities[] = {{.name = "speed", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { cosine, sine, spacing };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "cosine", .unit = "{port}", .lower = -1e15, .upper = 1e15, .scale = 1.0, .doc = "amplitude in phase with the cosine"},
      {.name = "sine", .unit = "{port}", .lower = -1e15, .upper = 1e15, .scale = 1.0, .doc = "amplitude in phase with the sine"},
      {.name = "spacing",
       .kind = CoefficientKind::shape,
       .value = 1.0,
       .unit = "{speed} s",
       .lower = 1e-12,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "way after which the force recurs",
       .scan = {.from = 2.0, .to = 1e4, .count = -1, .over = "speed dt"}},
  };
  enum State { turned };
  static constexpr OwnStateSpec states[] = {{.name = "turned", .unit = "{speed} s"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    F[port] = wave(T(in.z[turned] / in.c[spacing]), in.c[cosine], in.c[sine]);
    drift[turned] = in.q[speed];
  }

  static double fastest_rate(const Reads<double, double>& in) { return 2.0 * std::numbers::pi / in.c[spacing] * std::abs(in.q[speed]); }

  static std::vector<Example> examples() {
    return {{.quantities = {2.0},
             .coefficients = {3.0, 5.0, 0.2},
             .states = {0.05},
             .ports = {5.0},
             .drifts = {2.0},
             .source = "a quarter of the spacing: the sine"},
            {.quantities = {-1.0},
             .coefficients = {3.0, 5.0, 1.5},
             .states = {-0.25},
             .t = 1.0,
             .ports = {-2.83012702},
             .drifts = {-1.0},
             .source = "-60 deg: 3/2 - 5 x 0.866025404"}};
  }
};

}  // namespace

MISFIT_EFFECT(turning_ripple, TurningRipple)
