#include "misfit/model/system_of.h"

namespace {

using namespace misfit;

/// Two tanks, one above the other, fed by a pump: a system of levels alone, with roles that more than one place can play.
struct TestTanks {
  [[maybe_unused]] static constexpr int NU = 1;
  static constexpr int NX = 2, NP = 0, NF = 2, NQ = 3, NK = 3, NY = 2;
  enum Constant { drain_1, drain_2, pump };

  explicit TestTanks(const SystemOptions& /*options*/) {}
  static std::vector<std::string> flags() { return {}; }

  template <class T, class K>
  void quantities(const T* x, const double* u, double /*t*/, const K* /*k*/, const T* /*P*/, std::uint64_t /*needed*/, T* q) const {
    q[0] = x[0];
    q[1] = x[1];
    q[2] = T(u[0]);
  }
  template <class T, class K>
  void rates(const T* x, const double* u, double /*t*/, const K* k, const T* /*P*/, const T* F, T* dx) const {
    dx[0] = k[pump] * u[0] - k[drain_1] * x[0] + F[0];
    dx[1] = k[drain_1] * x[0] - k[drain_2] * x[1] + F[1];
  }
  template <class T, class K>
  void outputs(const T* x, const double* /*u*/, double /*t*/, const K* /*k*/, T* y) const {
    y[0] = x[0];
    y[1] = x[1];
  }

  [[nodiscard]] SystemSpec spec() const {
    SystemSpec s;
    s.key = "test_tanks";
    s.doc = "two tanks with linear outflows";
    s.formula = "x1' = pump u - drain_1 x1, x2' = drain_1 x1 - drain_2 x2";
    s.source = "made up for the tests";
    s.states = {{"x1", "m", -1}, {"x2", "m", -1}};
    s.inputs = {{"u", "V", "pump", Hold::zero_order}};
    s.quantities = {{"x1", "m", "upper level", {}, false}, {"x2", "m", "lower level", {}, false}, {"u", "V", "pump", {"u"}, true}};
    s.base_quantities = 3;
    s.dynamic_ports = {{"dx1/dt", "m/s", "into the upper tank", "x1"}, {"dx2/dt", "m/s", "into the lower tank", "x2"}};
    s.force_ports = {"dx1/dt", "dx2/dt"};
    s.constants = {{"drain_1", "1/s", "outflow of the upper tank", 0.0, 1e6, true, 0.0},
                   {"drain_2", "1/s", "outflow of the lower tank", 0.0, 1e6, true, 0.0},
                   {"pump", "m/s/V", "inflow per volt", -1e6, 1e6, true, 0.0}};
    s.outputs = {{"y1", "m", 0, 1e-3}, {"y2", "m", 1, 1e-3}};
    s.roles = {{"level", "x2"}, {"port", "dx2/dt"}, {"to_port", "dx1/dt"}, {"input", "u"}, {"output", "y2"}, {"reading", "y2"}};
    s.fastest_rate = 1.0;
    return s;
  }
  [[nodiscard]] std::vector<DerivedCurve> derived_curves(const double* /*k*/) const { return {}; }
};

}  // namespace

MISFIT_SYSTEM(test_tanks, TestTanks)
