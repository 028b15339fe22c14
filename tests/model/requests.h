#pragma once

// Models for tests: the parachute in both forms and a cart on a spring, with any effects.

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "misfit/model/evaluator.h"
#include "misfit_models_registry.h"
#include "misfit_test_effects_registry.h"

namespace misfit::testing_models {

inline constexpr double degree = 3.14159265358979323846 / 180.0;

inline const Registry& registry() {
  static const std::unique_ptr<const Registry> known = [] {
    auto made = std::make_unique<Registry>();
    misfit_models_register(*made);
    misfit_test_effects_register(*made);
    return made;
  }();
  return *known;
}

inline EffectRequest effect(const std::string& key, const std::map<std::string, std::string>& roles = {}, const std::string& name = "") {
  return {name.empty() ? key : name, key, roles, Source{"study.toml", 30, 1}};
}

/// The parachute of the paper (lib/misfit/README.md, [1]): static moment and damping as curves, gravity, coning, and `more`.
inline ModelRequest parachute(bool induced_angle, const std::vector<EffectRequest>& more = {}) {
  ModelRequest r;
  r.system = "parachute_planar";
  r.system_where = {"study.toml", 4, 1};
  r.options.flags["induced_angle"] = induced_angle;
  r.constants = {{"D", 1.5816}, {"S", 1.9554}, {"R_cp", 3.15}, {"m", 0.206}, {"m_a", 0.294}, {"qbar", 736.0}, {"V", 35.1}};
  for (const auto& [name, value] : r.constants) r.constants_where[name] = {"study.toml", 12, 1};
  r.effects = {effect("static_moment"), effect("pitch_damping"), effect("gravity"), effect("coning")};
  r.effects.insert(r.effects.end(), more.begin(), more.end());
  const std::string damping = induced_angle ? "C_mq" : "C_m_alphadot";
  r.curves["C_m"] = {"alpha_T", {4 * degree, 8 * degree, 10 * degree, 13 * degree, 18 * degree, 30 * degree}, {}, {"study.toml", 40, 1}};
  r.curves[damping] = {"alpha_T", {5 * degree, 11 * degree, 14 * degree, 28 * degree}, {}, {"study.toml", 41, 1}};
  return r;
}

/// The same canopy in three dimensions, in pixels of one camera.
inline ModelRequest spherical(const std::vector<EffectRequest>& more = {}) {
  ModelRequest r = parachute(true);
  r.system = "parachute_spherical";
  r.options.flags.clear();
  for (const auto& [name, value] :
       std::map<std::string, double>{{"R", 3.447}, {"l_b", 5.69}, {"l_s", 5.61}, {"h_c", 0.1524}, {"K", 133.86}})
    r.constants[name] = value;
  r.effects = {effect("static_moment"), effect("pitch_damping"), effect("gravity")};
  r.effects.insert(r.effects.end(), more.begin(), more.end());
  return r;
}

inline ModelRequest cart(const std::vector<EffectRequest>& effects) {
  ModelRequest r;
  r.system = "test_oscillator";
  r.system_where = {"study.toml", 4, 1};
  r.constants = {{"mass", 2.0}, {"stiffness", 30.0}};
  r.effects = effects;
  return r;
}

/// Two tanks that drain in 20 s and 25 s.
inline ModelRequest tanks(const std::vector<EffectRequest>& effects) {
  ModelRequest r;
  r.system = "test_tanks";
  r.system_where = {"study.toml", 4, 1};
  r.constants = {{"drain_1", 0.05}, {"drain_2", 0.04}, {"pump", 0.01}};
  r.effects = effects;
  return r;
}

/// A system of models/*.toml.
inline ModelRequest declared(const std::string& system, const std::vector<EffectRequest>& effects) {
  ModelRequest r;
  r.system = system;
  r.system_where = {"study.toml", 4, 1};
  r.effects = effects;
  return r;
}

inline void set(Model& model, const std::string& name, double value) {
  const int index = model.find_parameter(name);
  if (index < 0) throw std::logic_error("no parameter " + name);
  model.parameters[static_cast<std::size_t>(index)].value = value;
}

/// Coefficients of a curve such that it is a straight line over its knots.
inline void set_line(Model& model, const std::string& name, double x0, double value0, double slope) {
  const Curve* curve = model.find_curve(name);
  if (curve == nullptr) throw std::logic_error("no curve " + name);
  const Eigen::VectorXd line = curve->spline.line(x0, value0, slope);
  for (Eigen::Index i = 0; i < line.size(); ++i) model.parameters[static_cast<std::size_t>(curve->first + i)].value = line[i];
}

/// C_m and the damping near the paper's: trim at 12 deg, slope −0.0062/deg, C_mq = −0.25.
inline void set_parachute_curves(Model& model) {
  set_line(model, "C_m", 12.0 * degree, 0.0, -0.0062 / degree);
  set_line(model, model.find_curve("C_mq") != nullptr ? "C_mq" : "C_m_alphadot", 12.0 * degree, -0.25, 0.3);
}

/// Moves every parameter of an effect by up to 30 % of its scale or value, so that no derivative is zero by accident. Constants stay.
inline void shake(Model& model, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-0.3, 0.3);
  const std::size_t constants = model.system->spec().constants.size();
  for (std::size_t i = constants; i < model.parameters.size(); ++i) {
    Parameter& p = model.parameters[i];
    const double moved = p.value + uniform(random) * (p.value != 0.0 ? std::abs(p.value) : p.scale);
    if (moved > p.lower && moved < p.upper) p.value = moved;
  }
}

inline void free_all_constants(ModelRequest& request) {
  const std::unique_ptr<System> system = registry().system(request.system).make(request.options);
  for (const auto& constant : system->spec().constants) request.parameters[constant.name].free = true;
}

}  // namespace misfit::testing_models
