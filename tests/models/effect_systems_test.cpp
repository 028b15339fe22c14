// Laws over every registered effect inside the systems that it suits.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;

class EffectInSystems : public testing::TestWithParam<std::string> {};

/// The first effect that owns a coefficient of this name.
std::string owner_of(const std::string& coefficient) {
  for (const auto& key : registry().effect_keys()) {
    for (const auto& c : registry().effect(key).spec().coefficients) {
      if (!c.shared && c.name == coefficient) return key;
    }
  }
  throw std::logic_error("no effect owns '" + coefficient + "': add one whose coefficient of that name is not .shared");
}

/// Roles without a default: an effect of unknown form has to be told of what it is a curve.
std::map<std::string, std::string> roles_without_default(const EffectSpec& spec, const ModelRequest& request, const Registry& systems) {
  std::map<std::string, std::string> out;
  for (const CoefficientSpec& c : spec.coefficients) {
    if (const int role = spec.curve_role(c); role >= 0)
      out[spec.quantities[static_cast<std::size_t>(role)].name] =
          systems.system(request.system).make(request.options)->spec().quantities.front().name;
  }
  return out;
}

/// Models in which the effect binds with its default roles; why it does not in the others.
struct ModelsWith {
  std::vector<Model> models;
  std::string refusals;
};

/// Heat that goes from one body to another: a parameter that stands in two equations.
const std::string two_bodies = R"toml(
[states]
warm = { unit = "K" }
cold = { unit = "K" }
[parameters]
over = { unit = "1/s", value = 0.1, free = true }
[equations]
warm = "-over*(warm - cold)"
cold = "over*(warm - cold)"
[outputs]
warm = { unit = "K", noise = 0.1 }
)toml";

/// A motor of which the speed alone is a state.
const std::string motor = R"toml(
[states]
w = { unit = "rad/s" }
[parameters]
braking = { unit = "1/s", value = 0.1, free = true }
[equations]
w = "-braking*w"
[outputs]
w = { unit = "rad/s", noise = 0.1 }
)toml";

/// A gear and the load on its teeth, in the unit of what accelerates it.
const std::string gear = R"toml(
[states]
angle = { unit = "rad" }
speed = { unit = "rad/s", rate_of = "angle" }
[inputs]
drive = { unit = "rad/s^2" }
[parameters]
braking = { unit = "1/s", value = 0.1, free = true }
[quantities]
load = { unit = "rad/s^2", formula = "drive - braking*speed" }
[equations]
speed = "drive - braking*speed"
[outputs]
angle = { unit = "rad", noise = 0.1 }
)toml";

/// Alone in the system of the request.
void try_in(const ModelRequest& request, const Registry& systems, const std::string& key, ModelsWith& out) {
  ModelRequest alone = request;
  alone.effects = {effect(key)};
  alone.effects.front().roles = roles_without_default(registry().effect(key).spec(), request, systems);
  for (const auto& c : registry().effect(key).spec().coefficients) {
    if (c.shared) alone.effects.push_back(effect(owner_of(c.name)));
  }
  alone.curves.clear();
  for (const auto& [name, of] : curves_without_knots(alone, systems)) alone.curves[name] = {of, {0.1, 0.2}, {}, {}};
  try {
    out.models.push_back(assemble(alone, systems));
  } catch (const InputError& error) {  // does not suit this system
    out.refusals += "\n  " + request.system + ": " + error.what();
  }
}

ModelsWith models_with(const std::string& key) {
  ModelsWith out;
  static const std::shared_ptr<Registry> with_bodies = testing_models::registry_with(two_bodies),
                                         with_motor = testing_models::registry_with(motor), with_gear = testing_models::registry_with(gear);
  for (const auto& request : {parachute(true), parachute(false), spherical(), cart({}), tanks({}), declared("pendulum", {}),
                              declared("cascaded_tanks", {}), declared("duffing", {}), declared("text", {})})
    try_in(request, *with_bodies, key, out);
  try_in(declared("text", {}), *with_motor, key, out);
  try_in(declared("text", {}), *with_gear, key, out);
  return out;
}

TEST_P(EffectInSystems, SuitsAtLeastOneSystemWithItsDefaultRoles) {
  const ModelsWith found = models_with(GetParam());
  EXPECT_FALSE(found.models.empty()) << "mend the roles and units of " << GetParam()
                                     << ".cpp, or add a system that it suits to models_with() of tests/models/effect_systems_test.cpp, "
                                        "for example `declared(\"SYSTEM\", {})`. What the systems there say:"
                                     << found.refusals;
}

/// Power that the first effect of a model gives to the dynamic ports it acts on, at random states, inputs and coefficients.
double random_power(const Model& model, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const SystemSpec& system = model.system->spec();
  const BoundEffect& bound = model.effects.front();
  const EffectSpec& spec = bound.effect->spec();
  std::vector<double> x(static_cast<std::size_t>(model.states())), u(static_cast<std::size_t>(model.inputs()) + 1),
      q(system.quantities.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = (i < system.states.size() ? 2.0 * system.states[i].scale : 1.0) * normal(random);
  for (double& value : u) value = normal(random);
  Evaluator(model).quantities(x.data(), u.data(), 0.0, q.data());
  Example at;
  for (int i : bound.quantities) at.quantities.push_back(i < 0 ? 0.0 : q[static_cast<std::size_t>(i)]);
  for (const auto& c : spec.coefficients) at.coefficients.push_back(std::clamp(c.value + 3.0 * c.scale * normal(random), c.lower, c.upper));
  at.states.assign(spec.states.size(), normal(random));
  for (int i : bound.constants) at.constants.push_back(model.parameters[static_cast<std::size_t>(i)].value);
  std::vector<double> out(spec.ports.size() + spec.states.size());
  bound.effect->evaluate({at.quantities.data(), at.coefficients.data(), at.states.data(), at.constants.data(), 0.0}, out.data());
  double power = 0.0;
  for (std::size_t p = 0; p < bound.ports.size(); ++p) {
    if (bound.ports[p] < 0 || bound.kind != PortKind::dynamic) continue;
    const auto& conjugate = system.dynamic_ports[static_cast<std::size_t>(bound.ports[p])].conjugate;
    for (std::size_t i = 0; i < system.quantities.size(); ++i) power += system.quantities[i].name == conjugate ? out[p] * q[i] : 0.0;
  }
  return power;
}

TEST_P(EffectInSystems, NeverAddsPowerIfDeclaredDissipative) {
  if (!registry().effect(GetParam()).spec().dissipative) return;
  std::mt19937 random(5);
  int judged = 0;
  for (const Model& model : models_with(GetParam()).models) {
    for (int trial = 0; trial < 300; ++trial) {
      const double power = random_power(model, random);
      EXPECT_LE(power, 0.0);
      judged += power < 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(judged, 100) << "no system gave power to judge: add one on which " << GetParam() << " acts to models_with()";
}

INSTANTIATE_TEST_SUITE_P(Every, EffectInSystems, testing::ValuesIn(registry().effect_keys()), [](const auto& key) { return key.param; });

}  // namespace
}  // namespace misfit
