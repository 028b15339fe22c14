// Generic effects hidden in small systems that are not the parachute: are they named, where they are, and nothing else?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "misfit/discover/discover.h"
#include "misfit/discover/specimen.h"
#include "misfit/sim/step.h"
#include "tests/model/requests.h"

namespace misfit {
namespace {

using namespace testing_models;
using Values = std::map<std::string, double>;

/// What the system does with `hidden` in it: an input held at random for 20 samples, small random pushes, all states read with white noise.
Signals record(const ModelRequest& request, const Values& values, double step, double input, const std::vector<double>& noise,
               unsigned seed) {
  Model truth = assemble(request, registry());
  for (const auto& [name, value] : values) set(truth, name, value);
  const SystemSpec& spec = truth.system->spec();
  Signals s;
  s.name = "record";
  for (const auto& i : spec.inputs) s.inputs.push_back({i.name, i.unit, {}});
  for (const auto& o : spec.outputs) s.measured.push_back({o.name, o.unit, {}});
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  constexpr std::size_t samples = 2500, held = 20;
  double u = 0.0;
  for (std::size_t k = 0; k < samples; ++k) {
    if (k % held == 0) u = std::abs(input) * (input < 0.0 ? std::abs(normal(random)) : normal(random));
    s.t.push_back(step * static_cast<double>(k));
    s.inputs[0].values.push_back(u);
  }
  Stepper stepper(truth);
  std::vector<double> x(static_cast<std::size_t>(truth.states()), 0.0);
  stepper.prepare(x.data(), &s.inputs[0].values[0], 0.0);
  for (std::size_t k = 0; k < samples; ++k) {
    for (std::size_t i = 0; i < s.measured.size(); ++i) s.measured[i].values.push_back(x[i] + noise[i] * normal(random));
    if (k + 1 == samples) break;
    EXPECT_TRUE(stepper.step(x.data(), {s.t[k], s.t[k + 1], &s.inputs[0].values[k], &s.inputs[0].values[k + 1]}));
    for (std::size_t i = 0; i < noise.size(); ++i) {
      if (spec.states[i].rate_of >= 0 || spec.key == "test_tanks") x[i] += 0.3 * noise[i] * normal(random);
    }
  }
  return s;
}

Discovery discovered(ModelRequest model, const std::vector<std::string>& free, const Signals& recorded) {
  for (const auto& name : free) model.parameters[name].free = true;
  const std::vector<Signals> signals = {recorded};
  const Model start = assemble(model, registry());
  const FilterEstimate estimate = estimate_filter(start, {}, signals);
  return discover(estimate, model, registry(), signals);
}

Discovery in_cart(const std::string& hidden, const Values& values) {
  ModelRequest truth = cart({effect("viscous_friction")}), model = truth;
  if (!hidden.empty()) truth.effects.push_back(effect(hidden));
  Values all = values;
  all["viscosity"] = 1.5;
  return discovered(model, {"stiffness"}, record(truth, all, 0.05, 15.0, {2e-3, 1e-2}, 41));
}

Discovery in_tanks(const std::vector<EffectRequest>& hidden, const Values& values) {
  return discovered(tanks({}), {"drain_1", "drain_2", "pump"}, record(tanks(hidden), values, 2.0, -8.0, {2e-3, 2e-3}, 42));
}

void expect_first(const Discovery& found, const std::string& effect, const std::string& parameter, double value, double share) {
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_EQ(first.effect, effect) << found.verdict;
  EXPECT_TRUE(first.accepted) << first.why;
  ASSERT_TRUE(first.parameters.contains(parameter)) << found.verdict;
  EXPECT_NEAR(first.parameters.at(parameter).value, value, share * std::abs(value)) << found.verdict;
}

TEST(DiscoverGeneric, NamesAHiddenQuadraticDrag) {
  expect_first(in_cart("quadratic_drag", {{"drag", 1.0}}), "quadratic_drag", "drag", 1.0, 0.2);
}

TEST(DiscoverGeneric, NamesAHiddenCubicStiffness) {
  expect_first(in_cart("cubic_stiffness", {{"cubic_stiffness", 12.0}}), "cubic_stiffness", "cubic_stiffness", 12.0, 0.2);
}

/// Hysteresis with a small yield is nearly the same, and has a shape to spare.
TEST(DiscoverGeneric, NamesAHiddenCoulombFriction) {
  expect_first(in_cart("coulomb_friction", {{"friction", 1.5}}), "coulomb_friction", "friction", 1.5, 0.2);
}

TEST(DiscoverGeneric, NamesNothingWhereNothingIsHidden) {
  for (const auto& c : in_cart("", {}).candidates) EXPECT_FALSE(c.accepted) << c.effect << ": " << c.why;
}

TEST(DiscoverGeneric, NamesAnOverflowAndWhichTankItIs) {
  const Discovery found = in_tanks({effect("overflow", {{"level", "x1"}, {"port", "dx1/dt"}})}, {{"spill", 0.5}, {"threshold", 1.4}});
  expect_first(found, "overflow", "threshold", 1.4, 0.1);
  EXPECT_EQ(found.candidates.front().roles.at("level"), "x1");
  EXPECT_THAT(found.verdict, testing::HasSubstr("overflow (level = x1, port = dx1/dt)"));
}

TEST(DiscoverGeneric, ASecondOfAKindIsLookedForAtItsOwnPlace) {
  ModelRequest model = tanks({effect("overflow", {{"level", "x1"}, {"port", "dx1/dt"}}), effect("overflow", {}, "lower")});
  model.effects.pop_back();
  const Signals recorded = record(model, {{"spill", 0.5}, {"threshold", 1.4}}, 2.0, -8.0, {2e-3, 2e-3}, 43);
  model.parameters["threshold"].value = 1.4;
  model.parameters["spill"].value = 0.4;
  const std::vector<Signals> signals = {recorded};
  const FilterEstimate estimate = estimate_filter(assemble(model, registry()), {}, signals);
  std::vector<std::string> where;
  for (const auto& s : specimens(estimate, model, registry(), nullptr)) {
    if (s.effect != "overflow") continue;
    where.push_back(s.roles.at("level"));
    const int old = s.model.find_parameter("overflow.threshold");
    ASSERT_GE(old, 0) << "the first is called after its effect now";
    EXPECT_EQ(s.model.parameters[static_cast<std::size_t>(old)].value,
              estimate.model.parameters[static_cast<std::size_t>(estimate.model.find_parameter("threshold"))].value);
  }
  EXPECT_THAT(where, testing::ElementsAre("x2"));
}

/// A line at 1.3 Hz is found where it is, and not only at the frequency that a study would start from.
TEST(DiscoverGeneric, NamesAHiddenPeriodicForcingWithItsFrequency) {
  expect_first(in_cart("periodic_forcing", {{"cosine", 1.0}, {"sine", 0.5}, {"frequency", 1.3}}), "periodic_forcing", "frequency", 1.3,
               0.01);
}

}  // namespace
}  // namespace misfit
