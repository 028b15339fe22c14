#include "misfit/model/system_of.h"

namespace {

using namespace misfit;

/// Two tanks, one above the other, fed by a pump: a system of levels alone, with roles that more than one place can play.
struct TestTanks {
  [[maybe_unused]] static constexpr int NU = 1;
  static constexpr int NX = 2, NP = 0, NF = 2, NQ = 3, NK = 3, NY = 2;
  enum State { x1, x2 };
  enum Input { voltage };
  enum QuantityIndex { upper_level, lower_level, pump_voltage };
  enum DynamicPort { into_upper, into_lower };
  enum Constant { drain_1, drain_2, pump };
  enum Output { y1, y2 };

  explicit TestTanks(const SystemOptions& /*options*/) {}
  static std::vector<std::string> flags() { return {}; }

  template <class T, class K>
  void quantities(const PointOf<T, K>& at, std::uint64_t /*needed*/, T* q) const {
    const auto& [x, u, t, k, P] = at;
    q[upper_level] = x[x1];
    q[lower_level] = x[x2];
    q[pump_voltage] = T(u[voltage]);
  }
  template <class T, class K>
  void rates(const PointOf<T, K>& at, const T* F, T* dx) const {
    const auto& [x, u, t, k, P] = at;
    dx[x1] = k[pump] * u[voltage] - k[drain_1] * x[x1] + F[into_upper];
    dx[x2] = k[drain_1] * x[x1] - k[drain_2] * x[x2] + F[into_lower];
  }
  template <class T, class K>
  void outputs(const PointOf<T, K>& at, T* y) const {
    const auto& [x, u, t, k, P] = at;
    y[y1] = x[x1];
    y[y2] = x[x2];
  }

  [[nodiscard]] SystemSpec spec() const {
    SystemSpec s;
    s.key = "test_tanks";
    s.doc = "two tanks with linear outflows";
    s.formula = "x1' = pump u - drain_1 x1, x2' = drain_1 x1 - drain_2 x2";
    s.source = "made up for the tests";
    s.states = {{.name = "x1", .unit = "m"}, {.name = "x2", .unit = "m"}};
    s.inputs = {{.name = "u", .unit = "V", .doc = "pump", .hold = Hold::zero_order}};
    s.quantities = {{.name = "x1", .unit = "m", .doc = "upper level"},
                    {.name = "x2", .unit = "m", .doc = "lower level"},
                    {.name = "u", .unit = "V", .doc = "pump", .inputs = {"u"}, .carries_sign = true}};
    s.base_quantities = 3;
    s.dynamic_ports = {{.name = "dx1/dt", .unit = "m/s", .doc = "into the upper tank", .conjugate = "x1"},
                       {.name = "dx2/dt", .unit = "m/s", .doc = "into the lower tank", .conjugate = "x2"}};
    s.force_ports = {"dx1/dt", "dx2/dt"};
    s.constants = {{.name = "drain_1", .unit = "1/s", .doc = "outflow of the upper tank", .lower = 0.0, .upper = 1e6},
                   {.name = "drain_2", .unit = "1/s", .doc = "outflow of the lower tank", .lower = 0.0, .upper = 1e6},
                   {.name = "pump", .unit = "m/s/V", .doc = "inflow per volt", .lower = -1e6, .upper = 1e6}};
    s.outputs = {{.name = "y1", .unit = "m", .observes = x1, .noise = 1e-3}, {.name = "y2", .unit = "m", .observes = x2, .noise = 1e-3}};
    s.roles = {{"level", "x2"},  {"port", "dx2/dt"}, {"to_port", "dx1/dt"},  {"input", "u"},
               {"output", "y2"}, {"signal", "y2"},   {"other_output", "y1"}, {"other_signal", "y1"}};
    s.fastest_rate = 1.0;
    return s;
  }
  [[nodiscard]] std::vector<DerivedCurve> derived_curves(const double* /*k*/) const { return {}; }
};

}  // namespace

MISFIT_SYSTEM(test_tanks, TestTanks)
