#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Heat that a hot body radiates to surroundings of a constant temperature that nobody recorded: a furnace in its hall. That temperature is
/// fixed: an error of it is a constant, which the level at rest takes.
struct RadiationLoss {
  static constexpr const char* formula = "F = -radiation_loss (level^4 - surroundings^4)";
  static constexpr const char* symbols =
      "radiation_loss [port/level^4], level: a temperature that is a state [K], surroundings: that of what it sees [K], constant";
  static constexpr const char* valid = "absolute temperatures; grey surfaces whose emissivity does not depend on the temperature";
  static constexpr const char* size = "1 m^2 of emissivity 0.9 at 800 K in a hall of 20 degC: 20.5 kW";
  static constexpr const char* source = "Stefan-Boltzmann law, 5.670374e-8 W/m^2/K^4; Incropera et al. (2007), eq. 1.7";
  static constexpr const char* excludes = "surroundings whose temperature changes (radiation), conduction and convection";

  enum Quantity { level };
  static constexpr Role quantities[] = {{.name = "level", .unit = "K"}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { radiation_loss, surroundings };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "radiation_loss",
       .unit = "{port}/{level}^4",
       .lower = 0.0,
       .upper = 1e15,
       .scale = 1e-12,
       .doc = "heat per fourth power, over the heat capacity where the port is a rate of temperature"},
      {.name = "surroundings",
       .kind = CoefficientKind::shape,
       .value = 293.15,
       .unit = "{level}",
       .lower = 0.0,
       .upper = 1e4,
       .scale = 1.0,
       .doc = "temperature of the surroundings",
       .fixed = true},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T hot = in.q[level] * in.q[level];
    const T cold = in.c[surroundings] * in.c[surroundings];
    F[port] = in.c[RadiationLoss::radiation_loss] * (cold * cold - hot * hot);
  }

  static std::vector<Example> examples() {
    return {{.quantities = {800.0},
             .coefficients = {5.670374e-8 * 0.9, 293.15},
             .ports = {-20526.377413},
             .source = "Stefan-Boltzmann: 5.670374e-8 x 0.9 x (293.15^4 - 800^4) W"},
            {.quantities = {3.0}, .coefficients = {0.5, 2.0}, .t = 2.0, .ports = {-32.5}, .source = "by hand: 0.5 x (16 - 81)"}};
  }
};

}  // namespace

MISFIT_EFFECT(radiation_loss, RadiationLoss)
