#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A quantity port that is changed by a quantity and a constant of the system: enclosed air that grows with the tilt.
struct InertiaSwell {
  static constexpr const char* formula = "I = I0 + swell D^2 eta^2";
  static constexpr const char* symbols = "swell [kg], D [m], eta tilt [rad]";
  static constexpr const char* valid = "small tilts";
  static constexpr const char* size = "swell = 1 kg at eta = 0.2, D = 1.58 m: 0.1 kg m^2";
  static constexpr const char* source = "made up for the tests";
  static constexpr const char* excludes = "everything else";

  enum Quantity { eta };
  static constexpr Role quantities[] = {{.name = "eta", .unit = "rad"}};
  enum Port { inertia };
  static constexpr Role ports[] = {{.name = "inertia", .unit = "kg m^2"}};
  enum Constant { D };
  static constexpr const char* constants[] = {"D"};
  enum Coefficient { swell };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "swell", .unit = "kg", .lower = -100.0, .upper = 100.0, .scale = 1.0, .doc = "growth of the enclosed mass"},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    P[inertia] = in.c[swell] * (in.k[D] * in.k[D]) * in.q[eta] * in.q[eta];
  }

  static std::vector<Example> examples() {
    return {{.constants = {2.0}, .quantities = {0.5}, .coefficients = {3.0}, .ports = {3.0}, .source = "3 x 4 x 0.25"},
            {.constants = {1.0}, .quantities = {-2.0}, .coefficients = {0.5}, .ports = {2.0}, .source = "0.5 x 4"}};
  }
};

}  // namespace

MISFIT_EFFECT(inertia_swell, InertiaSwell)
