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
  static constexpr Role quantities[] = {{"input", "*"}};
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"delayed_gain", CoefficientKind::strength, 0.0, "{port}/{input}", -1e12, 1e12, 0.1, "force per input that comes late"},
      scanned({"delay", CoefficientKind::shape, 0.1, "s", 1e-6, 1e6, 0.1, "delay"}, {1.0, 20.0, 4, "step"})};
  static constexpr OwnStateSpec states[] = {{"z", "{input}", 0.0}, {"z_rate", "{input}/s", 0.0}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F, T* drift) {
    const T& tau = in.c[1];
    F[0] = -in.c[0] * tau * in.z[1];
    drift[0] = in.z[1];
    drift[1] = (12.0 * (in.q[0] - in.z[0]) / tau - 6.0 * in.z[1]) / tau;
  }

  /// Its poles lie at |s| = sqrt(12)/tau.
  static double fastest_rate(const Reads<double, double>& in) { return 3.4641 / in.c[1]; }

  static std::vector<Example> examples() {
    return {{{}, {3.0}, {2.0, 0.5}, {2.0, 1.5}, 0.0, {-1.5}, {1.5, 30.0}, "-2 x 0.5 x 1.5; 12 x 1/0.25 - 6 x 1.5/0.5"},
            {{}, {1.0}, {-1.0, 2.0}, {4.0, -0.25}, 1.0, {-0.5}, {-0.25, -8.25}, "by hand: 12 x -3/4 + 6 x 0.25/2"}};
  }
};

}  // namespace

MISFIT_EFFECT(delay, Delay)
