#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The input acts later than it is recorded: transport, a slow valve, a computer. Second-order Pade approximation by two own states: with
/// z1'' = 12/tau^2 (u - z1) - 6/tau z1' the delayed input is u - tau z1'.
struct Delay {
  static constexpr const char* formula =
      "F = delayed_gain (u(t - tau) - u), u(t - tau) = u - tau z_rate; z' = z_rate, z_rate' = 12/tau^2 (u - z) - 6/tau z_rate";
  static constexpr const char* symbols =
      "delayed_gain [port/input]: the gain by which the model lets the input act, tau delay [s], u the input [any], z, z_rate filtered "
      "input and its rate";
  static constexpr const char* valid = "signals slower than 1.7/tau (phase to 1 %); after a jump it rings for about tau";
  static constexpr const char* size = "tau = 0.1 s at 1 rad/s: 10 % of the input, 90 deg after it";
  static constexpr const char* source = "Golub and Van Loan, Matrix Computations, 11.3: Pade (2, 2) of exp(-tau s)";
  static constexpr const char* excludes = "delays longer than the fastest part of the input, delays that change";

  enum Quantity { input };
  static constexpr Role quantities[] = {{.name = "input", .unit = "*"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { delayed_gain, delay };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "delayed_gain",
       .unit = "{port}/{input}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "force per input that comes late",
       .whole = 1.0,
       .whole_of = "input"},
      {.name = "delay",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "s",
       .lower = 1e-9,
       .upper = 1e9,
       .scale = 0.1,
       .doc = "delay",
       .scan = {.from = 1.0, .to = 20.0, .count = 4, .over = "step"}},
  };
  enum State { z, z_rate };
  static constexpr OwnStateSpec states[] = {{.name = "z", .unit = "{input}"}, {.name = "z_rate", .unit = "{input}/s"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    const T& tau = in.c[delay];
    F[port] = -in.c[delayed_gain] * tau * in.z[z_rate];
    drift[z] = in.z[z_rate];
    drift[z_rate] = (12.0 * (in.q[input] - in.z[z]) / tau - 6.0 * in.z[z_rate]) / tau;
  }

  /// Its poles lie at |s| = sqrt(12)/tau.
  static double fastest_rate(const Reads<double, double>& in) { return 3.4641 / in.c[delay]; }

  static std::vector<Example> examples() {
    return {{.quantities = {3.0},
             .coefficients = {2.0, 0.5},
             .states = {2.0, 1.5},
             .ports = {-1.5},
             .drifts = {1.5, 30.0},
             .source = "-2 x 0.5 x 1.5; 12 x 1/0.25 - 6 x 1.5/0.5"},
            {.quantities = {1.0},
             .coefficients = {-1.0, 2.0},
             .states = {4.0, -0.25},
             .t = 1.0,
             .ports = {-0.5},
             .drifts = {-0.25, -8.25},
             .source = "by hand: 12 x -3/4 + 6 x 0.25/2"}};
  }
};

}  // namespace

MISFIT_EFFECT(delay, Delay)
