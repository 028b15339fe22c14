// A lag in front of a first-order system: which of the two time constants is whose, how well are they known, and what cannot be told apart
// from what is in the model already.
#include "misfit/discover/exchanged_poles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "misfit/discover/discover.h"
#include "misfit/discover/refit_forms.h"
#include "misfit/discover/verdict.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::HasSubstr;

const std::string motor_text = R"toml(
[states]
w = { unit = "rad/s" }
[inputs]
u = { unit = "V", hold = "zero_order" }
[parameters]
gain = { unit = "rad/s^2/V", value = 40.0, free = true }
damping = { unit = "1/s", value = 2.0, bounds = [0.0, 1000.0], free = true }
[equations]
w = "gain*u - damping*w"
[outputs]
w = { unit = "rad/s", noise = 0.1 }
)toml";

constexpr double gain = 60.0, damping = 2.5, lag = 0.06, noise = 0.1;

/// 30 s at 100 Hz: a voltage held at random for 0.2 s through a lag onto a motor, both first order, in closed form; two weak pushes a
/// second on the motor itself.
Signals record_of_motor(unsigned seed, double tau, double pushes) {
  constexpr int samples = 3000, held = 20;
  constexpr double step = 0.01;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "motor";
  s.inputs = {{"u", "V", {}, 0.0}};
  s.measured = {{"w", "rad/s", {}, 0.0}};
  double w = 0.0, z = 0.0, u = 0.0;
  for (int i = 0; i < samples; ++i) {
    if (i % held == 0) u = 2.0 * normal(random);
    s.t.push_back(step * i);
    s.inputs[0].values.push_back(u);
    s.measured[0].values.push_back(w + noise * normal(random));
    const double fast = std::exp(-step / tau), slow = std::exp(-damping * step), rest = gain * u / damping;
    const double of_lag = gain * (z - u) / (damping - 1.0 / tau);  // w' + damping w = gain (u + (z - u) exp(-t/tau))
    w = rest + of_lag * fast + (w - rest - of_lag) * slow + pushes * normal(random);
    z = u + (z - u) * fast;
  }
  return s;
}

void hold(ModelRequest& request, const std::string& name, double value) {
  request.parameters[name].value = value;
  request.parameters[name].free = false;
}

FilterEstimate estimate_of(const ModelRequest& request, const Registry& known, const std::vector<Signals>& signals) {
  return estimate_filter(assemble(request, known), {}, signals);
}

/// The lag acts on the input itself, where it is a share of 1: held there, it says nothing of the gain. (Held at a number, the gain was
/// known twenty times too well.)
TEST(ExchangedPoles, TheLagOfAnInputIsNotTakenForTheMotorsOwn) {
  const auto known = registry_with(motor_text);
  const ModelRequest model = request_of("text");
  const std::vector<Signals> signals = {record_of_motor(3, lag, 0.02)};
  const FilterEstimate estimate = estimate_of(model, *known, signals);
  const Discovery found = discover({estimate, model, *known, signals});
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  ASSERT_EQ(first.effect, "input_lag") << found.verdict;
  EXPECT_TRUE(first.accepted) << first.why;
  const Estimate& tau = first.parameters.at("input_tau");
  EXPECT_NEAR(tau.value, lag, 4.0 * tau.sigma) << found.verdict;
  EXPECT_LT(tau.sigma, 0.1 * lag);
  EXPECT_EQ(first.roles.at("port"), "u");
  EXPECT_EQ(first.parameters.at("lagged_gain").value, 1.0);

  ModelRequest with = model;
  with.effects.push_back(effect("input_lag", first.roles));
  hold(with, "lagged_gain", 1.0);
  with.parameters["input_tau"].value = tau.value;
  const FilterEstimate again = estimate_of(with, *known, signals);
  const std::vector<int> free = again.model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c) {
    const Parameter& p = again.model.parameters[static_cast<std::size_t>(free[c])];
    const double truth = p.name == "gain" ? gain : p.name == "damping" ? damping : lag;
    const auto at = static_cast<Eigen::Index>(c);
    EXPECT_NEAR(p.value, truth, 4.0 * std::sqrt(again.covariance(at, at))) << p.name;
  }
}

/// In a linear motor that nothing pushes, a lag of the input and one of the sensor are the same: moved to the input, it is still compared.
TEST(ExchangedPoles, ALagOfTheInputAndOneOfTheSensorAreSaidToBeOne) {
  const auto known = registry_with(motor_text);
  const ModelRequest model = request_of("text");
  const std::vector<Signals> signals = {record_of_motor(7, lag, 0.0)};
  const FilterEstimate estimate = estimate_of(model, *known, signals);
  const Candidate first = discover({estimate, model, *known, signals}).candidates.at(0);
  ASSERT_EQ(first.effect, "input_lag") << first.why;
  EXPECT_EQ(first.roles.at("port"), "u");
  EXPECT_THAT(first.group, testing::AllOf(testing::Contains(HasSubstr("input_lag")), testing::Contains(HasSubstr("sensor_lag"))));
}

TEST(ExchangedPoles, AreThoseOfTheEquations) {
  const auto known = registry_with(motor_text);
  ModelRequest model = request_of("text", {effect("input_lag", {{"input", "u"}, {"port", "u"}})});
  hold(model, "lagged_gain", 1.0);
  model.parameters["input_tau"].value = lag;
  const std::vector<Signals> signals = {record_of_motor(4, lag, 0.02)};
  const FilterEstimate estimate = estimate_of(model, *known, signals);
  const std::vector<double> constants = time_constants_of_system(estimate);
  ASSERT_EQ(constants.size(), 1U) << "the lag's own is none of the system's";
  EXPECT_NEAR(constants.front(), 1.0 / estimate.model.parameters[1].value, 1e-6);
  EXPECT_EQ(estimate.model.parameters[static_cast<std::size_t>(time_constant_of(estimate.model))].name, "input_tau");
  EXPECT_EQ(time_constant_of(assemble(request_of("text", {effect("delay", {{"input", "u"}, {"port", "u"}})}), *known)), -1)
      << "a delay has no pole";
}

TEST(NoLongerDetermined, NamesTheGainOfALinearMotorBesideTheScaleOfItsSensor) {
  const auto known = registry_with(motor_text);
  const std::vector<Signals> signals = {record_of_motor(5, 1e-4, 0.05)};
  const FilterEstimate without = estimate_of(request_of("text"), *known, signals);
  const FilterEstimate scaled = estimate_of(request_of("text", {effect("sensor_scale")}), *known, signals);
  const auto why = no_longer_determined(scaled, without);
  ASSERT_TRUE(why);
  EXPECT_THAT(*why, HasSubstr("gain is no longer determined"));
  const FilterEstimate rubbed =
      estimate_of(request_of("text", {effect("quadratic_drag", {{"rate", "w"}, {"port", "dw/dt"}})}), *known, signals);
  EXPECT_FALSE(no_longer_determined(rubbed, without)) << "drag and damping are told apart by large speeds";
}

TEST(NoLongerDetermined, IsNotATimeConstantThatWasTakenForTheLagAndIsNowKnownAsWell) {
  const auto known = registry_with(motor_text);
  const std::vector<Signals> signals = {record_of_motor(5, 1e-4, 0.05)};
  const FilterEstimate without = estimate_of(request_of("text"), *known, signals);
  FilterEstimate with = without;
  with.model.parameters[1].value *= 50.0;
  const double moved = with.model.parameters[1].value;
  const auto know_to = [&](double share) { with.covariance(1, 1) = std::pow(share * moved, 2); };
  know_to(0.1);
  EXPECT_FALSE(no_longer_determined(with, without)) << "its sigma is larger than the value before, but a tenth of the one now";
  know_to(0.3);
  EXPECT_TRUE(no_longer_determined(with, without));
}

/// What comes late of a system with one input and one output cannot be said; of two outputs, one of which comes late, it can.
TEST(AWholeDelayOfTheOnlyInput, IsAlsoOneOfTheOnlyOutput) {
  Refit refit;
  ModelRequest model = request_of("text", {effect("delay", {{"input", "u"}, {"port", "u"}})});
  refit.estimate.model = assemble(model, *registry_with(motor_text));
  note_output_as_late(refit);
  EXPECT_EQ(refit.also, "") << "a part of the input is late, and the output is not";
  hold(model, "delayed_gain", 1.0);
  refit.estimate.model = assemble(model, *registry_with(motor_text));
  note_output_as_late(refit);
  EXPECT_THAT(refit.also, HasSubstr("w late by as much, and u not, is the same"));
  std::string two_outputs = motor_text;
  two_outputs += "twice = { unit = \"rad/s\", formula = \"2*w\", noise = 0.1 }\n";
  refit.also.clear();
  refit.estimate.model = assemble(model, *registry_with(two_outputs));
  note_output_as_late(refit);
  EXPECT_EQ(refit.also, "");
}

}  // namespace
}  // namespace misfit
