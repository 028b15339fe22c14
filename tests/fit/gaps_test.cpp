// Recordings with time between two samples that no model can be run across.
#include "misfit/inference/gaps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/regression/equation_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "misfit/fit/trajectory_start.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::HasSubstr;

const std::string first_order_text = R"toml(
[states]
x = { unit = "V", scale = 1.0 }
[inputs]
u = { unit = "V", hold = "zero_order" }
[parameters]
a = { unit = "1/s", value = 0.5, bounds = [0.0, 100.0], free = true }
b = { unit = "1/s", value = 0.5, bounds = [-100.0, 100.0], free = true }
[equations]
x = "-a*x + b*u"
[outputs]
y = { unit = "V", formula = "x", noise = 0.01 }
)toml";

/// x' = rate (u − x) by its exact solution over steps of 0.1/rate, u on and off in turn; `gap` seconds pass before sample 101.
Signals first_order(double gap, double rate = 1.0, std::size_t samples = 201) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "e";
  s.measured = {{"y", "V", {}, 0.0}};
  s.inputs = {{"u", "V", {}, 0.0}};
  double x = 0.5;
  constexpr double step = 0.1, noise = 0.01;
  const double before = 1.0 / rate, left = std::exp(-step);
  for (std::size_t i = 0; i < samples; ++i) {
    const double u = (i / 25) % 2 == 0 ? 1.0 : 0.0;
    s.t.push_back(static_cast<double>(i) * step * before + (i > 100 ? gap : 0.0));
    s.inputs[0].values.push_back(u);
    s.measured[0].values.push_back(x + noise * normal(random));
    x = u + (x - u) * left;
    if (i == 100) x = u + (x - u) * std::exp(-gap * rate);
  }
  return s;
}

Model first_order_model(double a = 0.5) {
  const auto known = registry_with(first_order_text);
  ModelRequest request = request_of("text");
  request.parameters["a"].value = a;
  return assemble(request, *known);
}

void expect_right(const Fit& fit, double rate) {
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  for (const char* name : {"a", "b"}) {
    const Estimate& e = fit.parameters.at(name);
    EXPECT_NEAR(e.value, rate, 4.0 * e.sigma) << fit.method << " " << name;
    EXPECT_LT(e.sigma, 0.1 * rate) << fit.method << " " << name;
  }
}

TEST(Gaps, AnHourWithoutSamplesCutsTheRecording) {
  const Signals whole = first_order(3600.0);
  const std::vector<Signals> parts = split_at_gaps(first_order_model(), whole);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].name, "e_part_1");
  EXPECT_EQ(parts[1].name, "e_part_2");
  EXPECT_TRUE(is_part_of(parts[1], "e"));
  EXPECT_FALSE(is_part_of(parts[1], "f"));
  EXPECT_FALSE(parts[0].after_gap);
  EXPECT_TRUE(parts[1].after_gap);
  EXPECT_EQ(parts[0].samples(), 101U);
  EXPECT_EQ(parts[1].samples(), 100U);
  EXPECT_EQ(parts[1].inputs[0].values.front(), whole.inputs[0].values[101]);
  ASSERT_EQ(parts[0].notes.size(), 1U);
  EXPECT_THAT(parts[0].notes[0], HasSubstr("cut at 1 gap in time of up to 3600"));
}

TEST(Gaps, AfterAnHourEveryMethodHasTheRightAnswer) {
  const Model model = first_order_model();
  const std::vector<Signals> parts = split_at_gaps(model, first_order(3600.0));
  const TrajectoryStart start = trajectory_start(model, parts);
  expect_right(start.from.fit, 1.0);
  OutputErrorStart options;
  options.from_regression = start.regressed;
  const FittedModel fitted = output_error(start.from, parts, options);
  expect_right(fitted.fit, 1.0);
  EXPECT_NEAR(fitted.fit.rms.at("y").value, 0.01, 0.002);
  EXPECT_EQ(fitted.fit.predictions.size(), 2U);
  FilterOptions one;
  one.threads = 1;
  expect_right(filter_error(start.from, parts, one).fit, 1.0);
}

TEST(Gaps, ASharedInitialStateIsSaidToBeOneOfEachExperimentInTheFilter) {
  Model model = first_order_model();
  model.state_specs[0].initial = Initial::shared;
  const auto facts = [&](const std::vector<Signals>& experiments) {
    FilterOptions one;
    one.threads = 1;
    return filter_error(trajectory_start(model, experiments).from, experiments, one).fit.facts;
  };
  EXPECT_THAT(facts({first_order(0.0), first_order(0.0)}), testing::Contains(testing::Pair("shared initial states", HasSubstr("x: "))));
  EXPECT_THAT(facts({first_order(0.0)}), testing::Not(testing::Contains(testing::Key("shared initial states"))));
}

/// What is usual is not known of the first, which has 50 samples.
TEST(Gaps, OfEveryExperimentAreSaidThoughOneIsTooShort) {
  std::vector<Signals> experiments = {first_order(0.0, 1.0, 50), first_order(0.0)};
  experiments[0].name = "short";
  experiments[1].name = "long";
  for (std::size_t i = 120; i < 130; ++i) experiments[1].measured[0].values[i] = std::nan("");
  const Model model = first_order_model();
  FilterOptions one;
  one.threads = 1;
  const Fit fit = filter_error(trajectory_start(model, experiments).from, experiments, one).fit;
  EXPECT_THAT(fit.facts, testing::Contains(testing::Key("gaps: long")));
}

/// The same without an input that moves: on before the gap and after it.
Signals without_change(Signals signals) {
  for (double& u : signals.inputs[0].values) u = 1.0;
  return signals;
}

TEST(Gaps, AGapThatTheModelCanBeRunAcrossIsBridged) {
  EXPECT_EQ(split_at_gaps(first_order_model(0.001), without_change(first_order(3600.0, 0.001))).size(), 1U) << "a time constant of 1000 s";
  EXPECT_EQ(split_at_gaps(first_order_model(), without_change(first_order(5.0))).size(), 1U) << "50 steps, but five time constants";
  EXPECT_EQ(split_at_gaps(first_order_model(), first_order(0.0)).size(), 1U);
}

TEST(Gaps, MissingRowsWithInputsThatMayHaveChangedCutTheRecording) {
  const std::vector<Signals> parts = split_at_gaps(first_order_model(), first_order(5.0));
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].samples(), 101U);
  EXPECT_TRUE(parts[1].after_gap);
  ASSERT_EQ(parts[0].notes.size(), 1U);
  EXPECT_THAT(parts[0].notes[0], HasSubstr("cut at 1 gap in time of up to 5.1 s, in which inputs of the model are unknown"));
  EXPECT_EQ(split_at_gaps(first_order_model(), first_order(0.19)).size(), 1U) << "two rows";
  Signals drifting = first_order(5.0);
  for (std::size_t i = 0; i < drifting.samples(); ++i) drifting.inputs[0].values[i] = 1e-3 * drifting.t[i];
  EXPECT_EQ(split_at_gaps(first_order_model(), drifting).size(), 2U);
}

/// Recorded whenever something changed: what lies between two rows is known.
TEST(Gaps, ARecordingOfUnevenStepsIsNotCutAtItsLongerOnes) {
  Signals uneven = first_order(0.0);
  std::mt19937_64 random(5);
  std::exponential_distribution<double> step(10.0);
  double t = 0.0;
  for (double& at : uneven.t) at = t += step(random);
  EXPECT_EQ(split_at_gaps(first_order_model(), uneven).size(), 1U);
}

TEST(Gaps, TheDataTellHowFastTheMotionIsWhereTheStartDoesNot) {
  EXPECT_EQ(split_at_gaps(first_order_model(1e-4), first_order(3600.0)).size(), 2U);
}

TEST(Gaps, PartsTooShortForAStateAreLeftOutAndCounted) {
  Signals whole = first_order(3600.0);
  whole.t.back() += 7200.0;
  const std::vector<Signals> parts = split_at_gaps(first_order_model(), whole);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_THAT(parts[0].notes.back(), HasSubstr("1 sample in a part of fewer than 5 is not used"));
}

TEST(Gaps, ExcludedSamplesAreThoseOfTheRecordingsBeginning) {
  Signals whole = first_order(3600.0);
  whole.exclude = 7;
  const std::vector<Signals> parts = split_at_gaps(first_order_model(), whole);
  EXPECT_EQ(parts[0].exclude, 7U);
  EXPECT_EQ(parts[1].exclude, 0U);
}

/// A known first value is that of the recording, not of what follows a gap; and it counts as no unknown.
TEST(Gaps, AFixedInitialStateHoldsForTheFirstPartOnly) {
  const auto known = registry_with(first_order_text);
  ModelRequest request = request_of("text");
  request.initial["x"] = {Initial::fixed, 0.5, {}};
  const Model model = assemble(request, *known);
  const std::vector<Signals> parts = split_at_gaps(model, first_order(3600.0));
  const FittedModel fitted = output_error(equation_error(model, parts), parts);
  expect_right(fitted.fit, 1.0);
  EXPECT_NEAR(fitted.initial_states[0][0], 0.5, 1e-6);
  EXPECT_NEAR(fitted.initial_states[1][0], parts[1].measured[0].values[0], 0.05);
  EXPECT_NEAR(std::stod(fitted.fit.facts.at("effective_parameters")), 3.0, 1e-3) << "a, b and one initial state";
}

/// What stands first goes on after a gap: the others share a state that is not its.
TEST(Gaps, ASharedInitialStateIsNotThatOfAFirstPartAfterAGap) {
  const auto known = registry_with(first_order_text);
  ModelRequest request = request_of("text");
  request.initial["x"] = {Initial::shared, std::nullopt, {}};
  const Model model = assemble(request, *known);
  Signals late = first_order(0.0), one = first_order(0.0), two = first_order(0.0);
  late.after_gap = true;
  for (std::size_t i = 0; i < late.samples(); ++i) late.measured[0].values[i] += 2.0 * std::exp(-late.t[i]);
  for (Signals* s : {&one, &two}) {
    for (std::size_t i = 0; i < s->samples(); ++i) s->measured[0].values[i] += (s == &one ? 0.3 : -0.3) * std::exp(-s->t[i]);
  }
  const std::vector<Signals> experiments{late, one, two};
  const FittedModel fitted = output_error(equation_error(model, experiments), experiments);
  ASSERT_EQ(fitted.fit.status, FitStatus::converged) << fitted.fit.message;
  EXPECT_NEAR(fitted.initial_states[0][0], 2.5, 0.2);
  EXPECT_NEAR(fitted.initial_states[1][0], 0.5, 0.1) << "in the middle of both";
  EXPECT_NEAR(fitted.initial_states[2][0], fitted.initial_states[1][0], 1e-6);
}

TEST(EffectiveParameters, SharedInitialStatesAreOneUnknown) {
  const auto known = registry_with(first_order_text);
  ModelRequest request = request_of("text");
  request.initial["x"] = {Initial::shared, std::nullopt, {}};
  const Model model = assemble(request, *known);
  const std::vector<Signals> twice{first_order(0.0), first_order(0.0)};
  const FittedModel fitted = output_error(equation_error(model, twice), twice);
  EXPECT_NEAR(std::stod(fitted.fit.facts.at("effective_parameters")), 3.0, 1e-3);
}

}  // namespace
}  // namespace misfit
