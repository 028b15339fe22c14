#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A parameter of the model that is no constant, of which only the quantity is known that it depends on: the force factor of a loudspeaker
/// over the excursion of its coil, a stiffness over the load, an efficiency over the speed.
struct UnknownVariation {
  static constexpr const char* formula = "p = p0 + unknown_variation(with), wherever the parameter p stands";
  static constexpr const char* symbols =
      "unknown_variation [parameter], a curve (cubic spline) of the quantity `with` [any]; p0 the parameter's own value, fixed";
  static constexpr const char* valid = "a function of one quantity, where that was visited; beyond, the curve goes on straight";
  static constexpr const char* size = "the force factor of a loudspeaker, 5 N/A at rest, is 4 N/A at 4 mm: -1 N/A there";
  static constexpr const char* source =
      "P. C. Young, Data-based mechanistic modelling, Environmental Modelling & Software 13 (1998): state dependent parameters; "
      "W. Klippel, Loudspeaker nonlinearities, J. Audio Eng. Soc. 54 (2006): Bl(x)";
  static constexpr const char* excludes =
      "dependence on a second quantity, on time or on the past; a line or an exponential "
      "(varying_parameter)";

  enum Quantity { with };
  static constexpr Role quantities[] = {{.name = "with", .unit = "*"}};
  enum Port { parameter };
  static constexpr Role ports[] = {{.name = "parameter", .unit = "*"}};
  enum Coefficient { unknown_variation };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "unknown_variation",
       .unit = "{parameter}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 0.1,
       .doc = "what the parameter has beyond its own value",
       .curve_of = "with"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* p) {
    p[parameter] = in.c[UnknownVariation::unknown_variation];
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.004}, .coefficients = {-1.0}, .ports = {-1.0}, .source = "the value of the curve there"},
            {.quantities = {-0.002}, .coefficients = {0.3}, .t = 5.0, .ports = {0.3}, .source = "whatever the time"}};
  }
};

}  // namespace

MISFIT_EFFECT(unknown_variation, UnknownVariation)
