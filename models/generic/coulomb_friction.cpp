#include "misfit/math/regular.h"
#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Dry friction: constant, against the motion. Smoothed over `width` about rate 0, where a real bearing would stick. Where the system has a
/// second rate across the first, friction opposes the rotation as a whole: one size, direction of the rate vector.
struct CoulombFriction {
  static constexpr const char* formula = "F = -friction tanh(|rate|/width) rate/|rate|";
  static constexpr const char* symbols = "friction [port], width of the smoothing [rate], rate of the motion along the port(s) [any]";
  static constexpr const char* valid = "rates that are mostly above the width; below it the bearing creeps instead of sticking";
  static constexpr const char* size =
      "beside what else damps the motion: friction/(damping x rate); 20 N m at the swivel holds the parachute 1.4 deg away from its trim";
  static constexpr const char* source =
      "Andersson, Soderberg, Bjorklund, Tribology International 40 (2007): smooth Coulomb friction by tanh";
  static constexpr const char* excludes = "sticking, higher friction at the start of motion (Stribeck), viscous part (viscous_friction)";

  enum Quantity { rate, rate_lateral };
  static constexpr Role quantities[] = {{.name = "rate", .unit = "*"},
                                        {.name = "rate_lateral", .unit = "*", .optional = true, .completes = "rate"}};
  enum Port { port, port_lateral };
  static constexpr Role ports[] = {{.name = "port", .unit = "*"},
                                   {.name = "port_lateral", .unit = "*", .optional = true, .completes = "port"}};
  enum Coefficient { friction, width };
  static constexpr CoefficientSpec coefficients[] = {
      {.name = "friction", .unit = "{port}", .lower = 0.0, .upper = 1e15, .scale = 1.0, .doc = "size of the friction when moving"},
      {.name = "width",
       .kind = CoefficientKind::shape,
       .value = 0.1,
       .unit = "{rate}",
       .lower = 1e-12,
       .upper = 1e12,
       .scale = 0.01,
       .doc = "rate at which the smoothed friction has 76 % of its size",
       .fixed = true,
       .scan = {.from = 0.02, .to = 0.3, .count = 3, .over = "|rate|", .smooths = true}},
  };
  static constexpr bool dissipative = true;

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    const T along = in.q[rate] / in.c[width], across = in.q[rate_lateral] / in.c[width];
    const T resistance = in.c[friction] * tanh_over(T(along * along + across * across));
    F[port] = -resistance * along;
    F[port_lateral] = -resistance * across;
  }

  /// [1/s] The largest slope of the force over the rate, which it has at rate 0, times what a force does to the rate: how fast the rate
  /// dies out there.
  static double fastest_rate(const Reads<double, double>& in, double response) { return in.c[friction] / in.c[width] * response; }

  static std::vector<Example> examples() {
    return {
        {.quantities = {0.01, 0.0}, .coefficients = {20.0, 0.01}, .ports = {-15.2318831, 0.0}, .source = "20 tanh(1) = 20 x 0.761594156"},
        {.quantities = {-1.0, 0.0}, .coefficients = {3.0, 0.02}, .ports = {3.0, 0.0}, .source = "fully sliding, against the motion"},
        {.quantities = {0.3, -0.4},
         .coefficients = {10.0, 0.5},
         .ports = {-4.56956494, 6.09275325},
         .source = "|rate| = 0.5: 10 tanh(1) x (0.6, -0.8), against"}};
  }
};

}  // namespace

MISFIT_EFFECT(coulomb_friction, CoulombFriction)
