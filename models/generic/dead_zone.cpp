#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// A spring that acts only beyond a clearance on either side: stops, a loose joint. With a negative stiffness that cancels the linear one
/// it is a spring that gives way beyond the half width.
struct DeadZone {
  static constexpr const char* formula =
      "F = -stop_stiffness (displacement - half_width) above half_width, -stop_stiffness (displacement + half_width) below -half_width, "
      "else 0";
  static constexpr const char* symbols =
      "stop_stiffness [port/displacement], half_width of the clearance [displacement], displacement from the middle of it [any]";
  static constexpr const char* valid =
      "elastic contact without loss; the derivative at the corner is that of the side the displacement is on";
  static constexpr const char* size = "a stop of 1000 N m/rad, entered by 1 deg: 17 N m";
  static constexpr const char* source = "den Hartog, Mechanical Vibrations (1956), section 8.9: springs with clearance";
  static constexpr const char* excludes = "loss in the contact, unequal sides, play with memory (backlash)";
  static constexpr Role quantities[] = {{"displacement", "*"}};
  static constexpr Role ports[] = {{"port", "*"}};
  static constexpr CoefficientSpec coefficients[] = {
      {"stop_stiffness", CoefficientKind::strength, 0.0, "{port}/{displacement}", -1e12, 1e12, 1.0,
       "force per displacement beyond the clearance"},
      scanned({"half_width", CoefficientKind::shape, 0.1, "{displacement}", 0.0, 1e6, 0.1, "half of the clearance"},
              {0.3, 0.9, 4, "|displacement|"})};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[0] = -in.c[0] * beyond(in.q[0], in.c[1]);
  }

  static std::vector<Example> examples() {
    return {{{}, {0.5}, {100.0, 0.2}, {}, 0.0, {-30.0}, {}, "by hand: 100 x 0.3, back"},
            {{}, {-0.6}, {-5.0, 0.4}, {}, 0.0, {-1.0}, {}, "by hand: 5 x 0.2, outward"},
            {{}, {0.1}, {100.0, 0.2}, {}, 0.0, {0.0}, {}, "inside the clearance nothing acts"}};
  }
};

}  // namespace

MISFIT_EFFECT(dead_zone, DeadZone)
