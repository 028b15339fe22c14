#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Heat that moving air or water carries off: more than in proportion to the difference of temperatures where that difference itself moves
/// the fluid. Beside the linear loss of a model it is what bends that upwards.
struct Convection {
  static constexpr const char* formula = "F = convection (other - level) |(other - level)/1 K|^convection_power";
  static constexpr const char* symbols =
      "convection [port/K], level: a temperature that is a state [K], other: that of the fluid, a state or an input as recorded [K], "
      "convection_power [-]: 1/4 in laminar, 1/3 in turbulent free convection, more where a loss of another kind grows so";
  static constexpr const char* valid = "one fluid, properties that do not depend on the temperature, nothing else that moves the fluid";
  static constexpr const char* size = "a vertical wall of 1 m^2 in air, 1.42 W/K (30 K)^0.25 = 3.3 W/K at 30 K";
  static constexpr const char* source = "Incropera et al. (2007), eqs. 9.1 and 9.24: Nu = C Ra^n; McAdams: h = 1.42 (dT/L)^0.25 for air";
  static constexpr const char* excludes = "forced convection (exchange), radiation, condensation";

  enum Quantity { level, other };
  static constexpr Role quantities[] = {{.name = "level", .unit = "K"}, {.name = "other", .unit = "K", .input_too = true}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { convection, convection_power };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "convection",
       .unit = "{port}/{level}",
       .lower = 0.0,
       .upper = 1e15,
       .scale = 1e-6,
       .doc = "heat per kelvin at a difference of 1 K, over the heat capacity where the port is a rate of temperature"},
      {.name = "convection_power",
       .kind = CoefficientKind::shape,
       .value = 0.25,
       .unit = "-",
       .lower = 0.05,
       .upper = 3.0,
       .scale = 0.1,
       .doc = "how the loss per kelvin grows with the difference",
       .scan = {.from = 0.25, .to = 1.0, .count = 2}},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::pow;
    const T difference = in.q[other] - in.q[level];
    const T size = value_of(difference) < 0.0 ? T(-difference) : difference;
    F[port] = value_of(size) > 0.0 ? T(in.c[convection] * difference * pow(size, in.c[convection_power])) : T(0.0);
  }

  static std::vector<Example> examples() {
    return {
        {.quantities = {350.0, 334.0}, .coefficients = {1.42, 0.25}, .ports = {-45.44}, .source = "McAdams: 1.42 x 16^1.25 = 45.44 W/m^2"},
        {.quantities = {2.0, 5.0}, .coefficients = {0.5, 1.0}, .t = 2.0, .ports = {4.5}, .source = "by hand: 0.5 x 3 x 3"}};
  }
};

}  // namespace

MISFIT_EFFECT(convection, Convection)
