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
  static constexpr Role quantities[] = {{"eta", "rad"}};
  static constexpr Role ports[] = {{"inertia", "kg m^2"}};
  static constexpr const char* constants[] = {"D"};
  static constexpr CoefficientSpec coefficients[] = {
      {"swell", CoefficientKind::strength, 0.0, "kg", -100.0, 100.0, 1.0, "growth of the enclosed mass"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* P) {
    P[0] = in.c[0] * (in.k[0] * in.k[0]) * in.q[0] * in.q[0];
  }

  static std::vector<Example> examples() {
    return {{{2.0}, {0.5}, {3.0}, {}, 0.0, {3.0}, {}, "3 x 4 x 0.25"}, {{1.0}, {-2.0}, {0.5}, {}, 0.0, {2.0}, {}, "0.5 x 4"}};
  }
};

}  // namespace

MISFIT_EFFECT(inertia_swell, InertiaSwell)
