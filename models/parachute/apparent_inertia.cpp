#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// The air that moves with the canopy depends on how it lies in the wind: inertia that grows with the tilt.
struct ApparentInertia {
  static constexpr const char* formula = "I = (m + m_a) R_cp^2 + inertia_growth sin^2(eta)";
  static constexpr const char* symbols = "inertia_growth [kg m^2], eta tilt [rad]; I must stay positive over the tilts that are visited";
  static constexpr const char* valid = "quasi-steady; the tilt stands for alpha_T, on which a change of inertia cannot depend";
  static constexpr const char* size = "20 kg m^2 at 12 deg: 0.86 kg m^2, 17 % of I = 4.96";
  static constexpr const char* source =
      "Cockrell and Doherr, AIAA 1981-1940: apparent mass of parachutes depends on the direction of the acceleration";
  static constexpr const char* excludes = "the moment dI/dt omega, apparent mass of the lateral motion alone";

  enum Quantity { eta };
  static constexpr Role quantities[] = {{.name = "eta", .unit = "rad"}};
  enum Port { inertia };
  static constexpr Role ports[] = {{.name = "inertia", .unit = "kg m^2"}};
  enum Coefficient { inertia_growth };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "inertia_growth",
       .unit = "kg m^2",
       .lower = -100.0,
       .upper = 1e4,
       .scale = 10.0,
       .doc = "inertia per squared sine of the tilt"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    using std::sin;
    const T sine = sin(in.q[eta]);
    P[inertia] = in.c[inertia_growth] * sine * sine;
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.52359878}, .coefficients = {8.0}, .ports = {2.0}, .source = "by hand: sin 30 deg = 1/2"},
            {.quantities = {-0.20943951}, .coefficients = {20.0}, .ports = {0.86454542}, .source = "20 x 0.20791169^2"}};
  }
};

}  // namespace

MISFIT_EFFECT(apparent_inertia, ApparentInertia)
