#include "misfit/model/system_of.h"

namespace {

using namespace misfit;

/// A cart on a spring, driven by a held force: another system than the parachute, with two dynamic ports, a zero-order input, an optional
/// constant in an output, and outputs that are not called like a quantity.
struct TestOscillator {
  [[maybe_unused]] static constexpr int NU = 1;
  static constexpr int NX = 2, NP = 1, NF = 2, NQ = 4, NK = 3, NY = 2;
  enum State { x, v };
  enum Input { drive };
  enum QuantityIndex { place, speed, held_force, inertia };
  enum QuantityPort { added_mass };
  enum DynamicPort { force, slip };
  enum Constant { mass, stiffness, gain };
  enum Output { position_reading, speed_reading };

  explicit TestOscillator(const SystemOptions& /*options*/) {}
  static std::vector<std::string> flags() { return {}; }

  template <class T, class K>
  void quantities(const PointOf<T, K>& at, std::uint64_t /*needed*/, T* q) const {
    const auto& [s, u, t, k, P] = at;
    q[place] = s[x];
    q[speed] = s[v];
    q[held_force] = T(u[drive]);
    q[inertia] = k[mass] + P[added_mass];
  }
  template <class T, class K>
  void rates(const PointOf<T, K>& at, const T* F, T* dx) const {
    const auto& [s, u, t, k, P] = at;
    dx[x] = s[v] + F[slip];
    dx[v] = (F[force] + u[drive] - k[stiffness] * s[x]) / (k[mass] + P[added_mass]);
  }
  template <class T, class K>
  void outputs(const PointOf<T, K>& at, T* y) const {
    const auto& [s, u, t, k, P] = at;
    y[position_reading] = k[gain] * s[x];
    y[speed_reading] = s[v];
  }

  [[nodiscard]] SystemSpec spec() const {
    SystemSpec s;
    s.key = "test_oscillator";
    s.doc = "a cart on a spring";
    s.formula = "(mass + P) v' = drive - stiffness x + force, x' = v + slip";
    s.source = "made up for the tests";
    s.states = {{.name = "x", .unit = "m"}, {.name = "v", .unit = "m/s", .rate_of = x}};
    s.inputs = {{.name = "drive", .unit = "N", .doc = "held force", .hold = Hold::zero_order}};
    s.quantities = {{.name = "x", .unit = "m", .doc = "place"},
                    {.name = "v", .unit = "m/s", .doc = "speed"},
                    {.name = "drive", .unit = "N", .doc = "held force", .inputs = {"drive"}},
                    {.name = "inertia", .unit = "kg", .doc = "mass"}};
    s.base_quantities = inertia;
    s.quantity_ports = {{.name = "added_mass", .unit = "kg", .doc = "adds to the mass", .conjugate = "inertia"}};
    s.dynamic_ports = {{.name = "force", .unit = "N", .doc = "along x", .conjugate = "v"},
                       {.name = "slip", .unit = "m/s", .doc = "adds to the speed"}};
    s.constants = {
        {.name = "mass", .unit = "kg", .doc = "mass", .lower = 1e-9, .upper = 1e6},
        {.name = "stiffness", .unit = "N/m", .doc = "spring", .lower = 0.0, .upper = 1e9},
        {.name = "gain", .unit = "1/m", .doc = "of the position sensor", .lower = -1e3, .upper = 1e3, .required = false, .value = 1.0}};
    s.outputs = {{.name = "position_reading", .unit = "-", .noise = 1e-3},
                 {.name = "speed_reading", .unit = "m/s", .observes = v, .noise = 1e-3}};
    s.roles = {{"rate", "v"},         {"level", "x"},    {"port", "force"}, {"output", "position_reading"}, {"signal", "position_reading"},
               {"displacement", "x"}, {"input", "drive"}};
    s.fastest_rate = 2.0;
    return s;
  }
  [[nodiscard]] std::vector<DerivedCurve> derived_curves(const double* /*k*/) const { return {}; }
};

}  // namespace

MISFIT_SYSTEM(test_oscillator, TestOscillator)
