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

  enum Quantity { displacement };
  static constexpr Role quantities[] = {{.name = "displacement", .unit = "*", .input_too = true}};
  enum Port { port };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"}};
  enum Coefficient { stop_stiffness, half_width };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "stop_stiffness",
       .unit = "{port}/{displacement}",
       .lower = -1e15,
       .upper = 1e15,
       .scale = 1.0,
       .doc = "force per displacement beyond the clearance"},
      {.name = "half_width",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "{displacement}",
       .lower = 0.0,
       .upper = 1e12,
       .scale = 0.1,
       .doc = "half of the clearance",
       .scan = {.from = 0.3, .to = 0.9, .count = 4, .over = "|displacement|"}},
  };

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    F[port] = -in.c[stop_stiffness] * beyond(in.q[displacement], in.c[half_width]);
  }

  static std::vector<Example> examples() {
    return {{.quantities = {0.5}, .coefficients = {100.0, 0.2}, .ports = {-30.0}, .source = "by hand: 100 x 0.3, back"},
            {.quantities = {-0.6}, .coefficients = {-5.0, 0.4}, .ports = {-1.0}, .source = "by hand: 5 x 0.2, outward"},
            {.quantities = {0.1}, .coefficients = {100.0, 0.2}, .ports = {0.0}, .source = "inside the clearance nothing acts"}};
  }
};

}  // namespace

MISFIT_EFFECT(dead_zone, DeadZone)
