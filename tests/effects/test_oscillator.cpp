#include "misfit/model/system_of.h"

namespace {

using namespace misfit;

/// A cart on a spring, driven by a held force: another system than the parachute, with two dynamic ports, a zero-order input, an optional
/// constant in an output, and outputs that are not called like a quantity.
struct TestOscillator {
  [[maybe_unused]] static constexpr int NU = 1;
  static constexpr int NX = 2, NP = 1, NF = 2, NQ = 4, NK = 3, NY = 2;
  enum Constant { mass, stiffness, gain };

  explicit TestOscillator(const SystemOptions& /*options*/) {}
  static std::vector<std::string> flags() { return {}; }

  template <class T, class K>
  void quantities(const T* x, const double* u, double /*t*/, const K* k, const T* P, std::uint64_t /*needed*/, T* q) const {
    q[0] = x[0];
    q[1] = x[1];
    q[2] = T(u[0]);
    q[3] = k[mass] + P[0];
  }
  template <class T, class K>
  void rates(const T* x, const double* u, double /*t*/, const K* k, const T* P, const T* F, T* dx) const {
    dx[0] = x[1] + F[1];
    dx[1] = (F[0] + u[0] - k[stiffness] * x[0]) / (k[mass] + P[0]);
  }
  template <class T, class K>
  void outputs(const T* x, const double* /*u*/, double /*t*/, const K* k, T* y) const {
    y[0] = k[gain] * x[0];
    y[1] = x[1];
  }

  [[nodiscard]] SystemSpec spec() const {
    SystemSpec s;
    s.key = "test_oscillator";
    s.doc = "a cart on a spring";
    s.formula = "(mass + P) v' = drive - stiffness x + force, x' = v + slip";
    s.source = "made up for the tests";
    s.states = {{"x", "m", -1}, {"v", "m/s", 0}};
    s.inputs = {{"drive", "N", "held force", Hold::zero_order}};
    s.quantities = {{"x", "m", "place", {}, false},
                    {"v", "m/s", "speed", {}, false},
                    {"drive", "N", "held force", {"drive"}, false},
                    {"inertia", "kg", "mass", {}, false}};
    s.base_quantities = 3;
    s.quantity_ports = {{"added_mass", "kg", "adds to the mass", "inertia"}};
    s.dynamic_ports = {{"force", "N", "along x", "v"}, {"slip", "m/s", "adds to the speed", ""}};
    s.constants = {{"mass", "kg", "mass", 1e-9, 1e6, true, 0.0},
                   {"stiffness", "N/m", "spring", 0.0, 1e9, true, 0.0},
                   {"gain", "1/m", "of the position sensor", -1e3, 1e3, false, 1.0}};
    s.outputs = {{"position_reading", "-", -1, 1e-3}, {"speed_reading", "m/s", 1, 1e-3}};
    s.roles = {{"rate", "v"},         {"level", "x"},    {"port", "force"}, {"output", "position_reading"}, {"reading", "position_reading"},
               {"displacement", "x"}, {"input", "drive"}};
    s.fastest_rate = 2.0;
    return s;
  }
  [[nodiscard]] std::vector<DerivedCurve> derived_curves(const double* /*k*/) const { return {}; }
};

}  // namespace

MISFIT_SYSTEM(test_oscillator, TestOscillator)
