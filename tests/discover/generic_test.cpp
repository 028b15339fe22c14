// Generic effects hidden in small systems that are not the parachute: are they named, where they are, and nothing else?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/discover/candidate_model.h"
#include "misfit/discover/discover.h"
#include "tests/discover/record.h"

namespace misfit {
namespace {

using namespace testing_records;

Discovery discovered(ModelRequest model, const std::vector<std::string>& free, const Signals& recorded) {
  for (const auto& name : free) model.parameters[name].free = true;
  const std::vector<Signals> signals = {recorded};
  const Model start = assemble(model, registry());
  const FilterEstimate estimate = estimate_filter(start, {}, signals);
  return discover({estimate, model, registry(), signals});
}

/// A minute of the cart, or 40 of the tanks: enough for what is hidden here, and half the time of a longer record.
constexpr std::size_t short_record = 1200;

Signals short_record_of_cart(const std::vector<EffectRequest>& hidden, const Values& values) {
  return record_of_cart(hidden, values, 41, {}, short_record);
}

Discovery in_cart(const std::string& hidden, const Values& values, std::size_t samples = short_record) {
  const std::vector<EffectRequest> more = hidden.empty() ? std::vector<EffectRequest>{} : std::vector<EffectRequest>{effect(hidden)};
  return discovered(cart({effect("viscous_friction")}), {"stiffness"}, record_of_cart(more, values, 41, {}, samples));
}

Discovery in_tanks(const std::vector<EffectRequest>& hidden, const Values& values) {
  return discovered(tanks({}), {"drain_1", "drain_2", "pump"},
                    record(tanks(hidden), values, 2.0, -8.0, {2e-3, 2e-3}, 42, {}, short_record));
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

/// Hysteresis with a small yield is nearly the same, and has a shape to spare; hasty_friction of the tests is the same formula.
TEST(DiscoverGeneric, NamesAHiddenCoulombFriction) {
  const Discovery found = in_cart("coulomb_friction", {{"friction", 1.5}});
  const std::string first = found.candidates.empty() ? "" : found.candidates.front().effect;
  expect_first(found, first == "hasty_friction" ? first : "coulomb_friction", "friction", 1.5, 0.2);
}

/// Forces of 15 N RMS, of which the first 4 N do nothing.
TEST(DiscoverGeneric, FindsTheBandOfAnInputThatDoesNotAct) {
  const Discovery found = in_cart("input_dead_zone", {{"dead_gain", 1.0}, {"half_band", 4.0}});
  expect_first(found, "input_dead_zone", "half_band", 4.0, 0.1);
  EXPECT_NEAR(found.candidates.front().parameters.at("dead_gain").value, 1.0, 0.02) << "the force acts on the mass with its gain of 1";
}

/// The forces jump by tens of newtons, which takes the actuator several of the samples of 50 ms.
TEST(DiscoverGeneric, FindsHowFastAnActuatorIs) {
  const Discovery found = in_cart("rate_limit", {{"limited_gain", 1.0}, {"rate_limit", 60.0}, {"follow_time", 0.025}});
  expect_first(found, "rate_limit", "rate_limit", 60.0, 0.05);
  EXPECT_NEAR(found.candidates.front().parameters.at("limited_gain").value, 1.0, 0.02) << "the force acts on the mass with its gain of 1";
}

/// The side that follows is carried along at once; the refit begins with two of the samples of 50 ms for it, which is a lag.
TEST(DiscoverGeneric, FindsAPlayWithoutALagBesideIt) {
  const Discovery found = in_cart("backlash", {{"play_stiffness", 8.0}, {"play", 0.3}, {"backlash_tau", 0.002}});
  expect_first(found, "backlash", "play", 0.3, 0.1);
  EXPECT_LT(found.candidates.front().parameters.at("backlash_tau").value, 0.02);
}

TEST(DiscoverGeneric, FindsAStopOnEitherSide) {
  const Discovery below = in_cart("lower_stop", {{"stop_stiffness", 20.0}, {"edge", -0.5}});
  expect_first(below, "lower_stop", "edge", -0.5, 0.05);
  EXPECT_NEAR(below.candidates.front().parameters.at("stop_stiffness").value, 20.0, 1.0);
  const Discovery above = in_cart("upper_stop", {{"stop_stiffness", 20.0}, {"edge", 0.5}});
  expect_first(above, "upper_stop", "edge", 0.5, 0.05);
}

TEST(DiscoverGeneric, FindsADampingThatAnInputSets) {
  const Signals recorded = short_record_of_cart({effect("bilinear", {{"factor", "v"}})}, {{"product", -0.05}, {"neutral", 0.0}});
  const Discovery found = discovered(cart({effect("viscous_friction")}), {"stiffness"}, recorded);
  expect_first(found, "bilinear", "product", -0.05, 0.1);
  EXPECT_EQ(found.candidates.front().roles.at("factor"), "v");
}

/// A pump that stirs: the faster it runs, the more the levels exchange.
TEST(DiscoverGeneric, FindsAnExchangeThatAnInputSets) {
  const EffectRequest stirred = effect("bilinear_exchange", {{"level", "x2"}, {"other", "x1"}, {"input", "u"}, {"port", "dx2/dt"}});
  const Discovery found = in_tanks({stirred}, {{"exchange_per_input", 0.004}});
  expect_first(found, "bilinear_exchange", "exchange_per_input", 0.004, 0.2);
}

/// The share that is late can be traded for the time constant while that is short: an actuator is late as a whole or not at all.
TEST(DiscoverGeneric, FindsTheWholeLagOfAnActuator) {
  const Discovery found = in_cart("input_lag", {{"lagged_gain", 1.0}, {"input_tau", 0.06}});
  expect_first(found, "input_lag", "input_tau", 0.06, 0.1);
  const Candidate& first = found.candidates.front();
  EXPECT_NEAR(first.parameters.at("lagged_gain").value, 1.0, 0.02) << "the force acts on the mass with its gain of 1";
  EXPECT_THAT(first.fixed, testing::ElementsAre("lagged_gain"));
}

/// The record of the cart whose position is stamped `shift` samples early (what it was later) or late.
Signals with_shifted_position(int shift) {
  Signals s = short_record_of_cart({}, {});
  std::vector<double>& position = s.measured[0].values;
  if (shift > 0) {
    position.erase(position.begin(), position.begin() + shift);
    position.insert(position.end(), shift, std::nan(""));
  } else {
    position.erase(position.end() + shift, position.end());
    position.insert(position.begin(), -shift, std::nan(""));
  }
  return s;
}

TEST(DiscoverGeneric, NamesTheClockOfASensorThatIsEarly) {
  const Discovery found = discovered(cart({effect("viscous_friction")}), {"stiffness"}, with_shifted_position(1));
  expect_first(found, "sensor_clock", "sensor_offset", 0.05, 0.02);
  EXPECT_EQ(found.candidates.front().roles.at("time_of_output"), "sample_time_position_reading");
  EXPECT_NEAR(found.candidates.front().parameters.at("sensor_offset").value, 0.05,
              3.0 * found.candidates.front().parameters.at("sensor_offset").sigma);
}

TEST(DiscoverGeneric, CallsASensorThatIsLateLate) {
  expect_first(discovered(cart({effect("viscous_friction")}), {"stiffness"}, with_shifted_position(-1)), "sensor_delay", "sensor_delay",
               0.05, 0.05);
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
  for (const auto& s : candidate_models(estimate, model, registry(), nullptr)) {
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

/// In 125 s the phase departs by 0.2 periods from that of any constant frequency.
TEST(DiscoverGeneric, LetsAFrequencyDriftThatDrifts) {
  const Discovery found =
      in_cart("periodic_forcing", {{"cosine", 1.0}, {"sine", 0.5}, {"frequency", 1.3}, {"frequency_drift", 2e-4}}, 2500);
  expect_first(found, "periodic_forcing", "frequency_drift", 2e-4, 0.1);
  const Candidate& first = found.candidates.front();
  EXPECT_NEAR(first.parameters.at("frequency").value, 1.3, 1e-3) << "at t = 0";
  EXPECT_THAT(first.free, testing::Contains("frequency_drift"));
  EXPECT_THAT(first.why, testing::HasSubstr("its frequency drifts by"));
}

TEST(DiscoverGeneric, AFrequencyThatDoesNotDriftIsFixed) {
  const Discovery found = in_cart("periodic_forcing", {{"cosine", 1.0}, {"sine", 0.5}, {"frequency", 1.3}});
  ASSERT_FALSE(found.candidates.empty());
  const Candidate& first = found.candidates.front();
  EXPECT_EQ(first.effect, "periodic_forcing");
  EXPECT_FALSE(first.parameters.contains("frequency_drift")) << "fixed at 0 it is no result";
  EXPECT_THAT(first.free, testing::Not(testing::Contains("frequency_drift")));
}

/// Noise before the rounding smooths the sawtooth that it adds to a prediction, to 0.6 of the whole here; as intervals the measurements are
/// what they are.
TEST(DiscoverGeneric, NamesARoundingAfterNoise) {
  Signals recorded = short_record_of_cart({}, {});
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  constexpr double step = 0.04, noise_of_step = 0.15;
  for (double& x : recorded.measured[0].values) x = step * std::round((x + noise_of_step * step * normal(random)) / step);
  const Discovery found = discovered(cart({effect("viscous_friction")}), {"stiffness"}, recorded);
  expect_first(found, "sensor_quantisation", "step", step, 1e-6);
  EXPECT_EQ(found.candidates.front().parameters.at("rounded").value, 1.0) << found.verdict;
  EXPECT_THAT(found.candidates.front().fixed, testing::ElementsAre("rounded"));
}

/// A level that keeps the same digits for many samples: densities count that for a random force which follows the stairs, probabilities
/// do not.
TEST(DiscoverGeneric, NamesStairsThatARandomForceFollows) {
  Signals recorded = record(tanks({}), {}, 2.0, -8.0, {2e-3, 2e-3}, 42, {}, short_record);
  constexpr double step = 0.25;
  for (double& level : recorded.measured[0].values) level = step * std::round(level / step);
  const Discovery found = discovered(tanks({}), {"drain_1", "drain_2", "pump"}, recorded);
  expect_first(found, "sensor_quantisation", "step", step, 1e-6);
  EXPECT_EQ(found.candidates.front().roles.at("output"), "y1");
  EXPECT_GT(found.candidates.front().actual_drop, 100.0);
}

}  // namespace
}  // namespace misfit
