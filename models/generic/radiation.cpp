#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Heat that is radiated: by a body to its surroundings, or between two bodies. It grows with the fourth power of the absolute temperature,
/// so that a hot body loses more than a linear loss says.
struct Radiation {
  static constexpr const char* formula = "F = radiation (other^4 - level^4)";
  static constexpr const char* symbols =
      "radiation [port/level^4], level: a temperature that is a state [K], other: that of what it sees, a state or an input as recorded "
      "[K]";
  static constexpr const char* valid = "absolute temperatures; grey surfaces whose emissivity does not depend on the temperature";
  static constexpr const char* size = "1 m^2 of emissivity 0.9 at 800 K: 21 kW";
  static constexpr const char* source = "Stefan-Boltzmann law, 5.670374e-8 W/m^2/K^4; Incropera et al. (2007), eq. 1.7";
  static constexpr const char* excludes =
      "conduction and convection (exchange, leak), surroundings of which nothing is recorded (radiation_loss)";

  enum Quantity { level, other };
  static constexpr Role quantities[] = {{.name = "level", .unit = "K"}, {.name = "other", .unit = "K", .input_too = true}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { radiation };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "radiation",
       .unit = "{port}/{level}^4",
       .lower = 0.0,
       .upper = 1e15,
       .scale = 1e-12,
       .doc = "heat per fourth power, over the heat capacity where the port is a rate of temperature"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T hot = in.q[level] * in.q[level], seen = in.q[other] * in.q[other];
    F[port] = in.c[radiation] * (seen * seen - hot * hot);
  }

  static std::vector<Example> examples() {
    return {{.quantities = {800.0, 300.0},
             .coefficients = {5.670374e-8 * 0.9},
             .ports = {-20489.896449},
             .source = "Stefan-Boltzmann: 5.670374e-8 x 0.9 x (300^4 - 800^4) W"},
            {.quantities = {2.0, 3.0}, .coefficients = {0.5}, .t = 2.0, .ports = {32.5}, .source = "by hand: 0.5 x (81 - 16)"}};
  }
};

}  // namespace

MISFIT_EFFECT(radiation, Radiation)
