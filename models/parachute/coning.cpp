#include "misfit/model/registry.h"

namespace {

using namespace misfit;

/// Centrifugal moment of the axis going round the wind: what the planar equation lacks when the motion is three-dimensional.
struct Coning {
  static constexpr const char* formula = "M = I phi'^2 sin(eta) cos(eta)";
  static constexpr const char* symbols = "I inertia about the swivel [kg m^2], phi' rate of the clock angle [rad/s], eta tilt [rad]";
  static constexpr const char* valid = "planar systems with measured phi(t); the spherical system has it by itself";
  static constexpr const char* size = "I = 4.96 kg m^2, phi' = 5 rad/s, eta = 12 deg: 25 N m, as large as the random moment";
  static constexpr const char* source = "spherical pendulum, eta'' = phi'^2 sin(eta) cos(eta) + M/I (Goldstein, Classical Mechanics)";
  static constexpr const char* excludes = "exchange of angular momentum with the lateral motion";

  enum Quantity { inertia, phi_rate, eta };
  static constexpr Role quantities[] = {
      {.name = "inertia", .unit = "kg m^2"}, {.name = "phi_rate", .unit = "rad/s"}, {.name = "eta", .unit = "rad"}};
  enum Port { pitching_moment };
  static constexpr Role ports[] = {{.name = "pitching_moment", .unit = "N m"}};

  template <class T, class K>
  static void add(const Reads<T, K>& in, T* F) {
    using std::cos;
    using std::sin;
    F[pitching_moment] = in.q[inertia] * in.q[phi_rate] * in.q[phi_rate] * sin(in.q[eta]) * cos(in.q[eta]);
  }

  static std::vector<Example> examples() {
    return {
        {.quantities = {4.96125, 5.0, 0.20943951}, .ports = {25.224027}, .source = "4.96125 x 25 x sin(24 deg)/2 = 124.03125 x 0.20336832"},
        {.quantities = {2.0, 3.0, 0.78539816}, .ports = {9.0}, .source = "by hand: 2 x 9 x sin 45 cos 45 = 9"}};
  }
};

}  // namespace

MISFIT_EFFECT(coning, Coning)
