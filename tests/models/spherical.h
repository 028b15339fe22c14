#pragma once

// The spherical parachute for tests: models with chosen effects, states from angles, runs.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "misfit/sim/step.h"
#include "tests/model/cases.h"

namespace misfit::testing_spherical {

using namespace testing_models;

using State = std::array<double, 4>;  ///< n_y, n_z and their rates
constexpr double R = 3.15, weight = 0.206 * 9.80665, I = (0.206 + 0.294) * R * R;

/// With these effects only; C_m and C_mq, where wanted, near the paper's.
inline Model with(const std::vector<EffectRequest>& effects, const std::map<std::string, double>& values = {}) {
  ModelRequest r = spherical();
  r.effects = effects;
  const auto open = curves_without_knots(
      [&] {
        ModelRequest bare = r;
        bare.curves.clear();
        return bare;
      }(),
      registry());
  std::erase_if(r.curves, [&](const auto& curve) { return !open.contains(curve.first); });
  Model m = assemble(r, registry());
  if (m.find_curve("C_m") != nullptr) set_line(m, "C_m", 12.0 * degree, 0.0, -0.0062 / degree);
  if (m.find_curve("C_mq") != nullptr) set_line(m, "C_mq", 12.0 * degree, -0.25, 0.3);
  for (const auto& [name, value] : values) set(m, name, value);
  return m;
}

inline State rates(const Model& m, const State& x, double t = 0.0) {
  Evaluator evaluator(m);
  State dx{};
  evaluator.rates(x.data(), nullptr, t, dx.data());
  return dx;
}

inline std::map<std::string, double> quantities(const Model& m, const State& x) {
  Evaluator evaluator(m);
  const auto& specs = m.system->spec().quantities;
  std::vector<double> q(specs.size());
  evaluator.quantities(x.data(), nullptr, 0.0, q.data());
  std::map<std::string, double> out;
  for (std::size_t i = 0; i < q.size(); ++i) out[specs[i].name] = q[i];
  return out;
}

inline double n_x(const State& x) { return std::sqrt(1.0 - x[0] * x[0] - x[1] * x[1]); }
inline double n_x_rate(const State& x) { return -(x[0] * x[2] + x[1] * x[3]) / n_x(x); }

/// Tilt and clock angle with their rates → state.
inline State from_angles(double eta, double phi, double eta_rate, double phi_rate) {
  const double s = std::sin(eta), c = std::cos(eta);
  return {s * std::sin(phi), s * std::cos(phi), c * std::sin(phi) * eta_rate + s * std::cos(phi) * phi_rate,
          c * std::cos(phi) * eta_rate - s * std::sin(phi) * phi_rate};
}

/// Turns the state about x so that the clock angle grows by `angle`.
inline State turned(const State& x, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * x[0] + s * x[1], c * x[1] - s * x[0], c * x[2] + s * x[3], c * x[3] - s * x[2]};
}

inline State run(const Model& m, State x, double seconds, const std::function<void(const State&)>& look = {}) {
  Stepper stepper(m);
  constexpr double h = 1e-3;
  stepper.prepare(x.data(), nullptr, 0.0);
  const auto steps = static_cast<int>(std::lround(seconds / h));
  for (int i = 0; i < steps; ++i) {
    if (look) look(x);
    EXPECT_TRUE(stepper.step(x.data(), {i * h, (i + 1) * h, nullptr, nullptr}));
  }
  return x;
}

inline const std::vector<State> some_states = {from_angles(0.2, 0.5, 0.3, 1.0), from_angles(0.35, -2.8, -1.0, -2.0),
                                               from_angles(0.05, 3.1, 2.0, 0.5), from_angles(0.6, 1.6, 0.0, 4.0)};

}  // namespace misfit::testing_spherical
