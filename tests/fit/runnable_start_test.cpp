#include "misfit/fit/filter/runnable_start.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fit/flight.h"

namespace misfit {
namespace {

using namespace testing_flight;
using testing::ElementsAre;
using testing::HasSubstr;

Model with_lateral_damping(const std::vector<Signals>& flights) {
  ModelRequest request = request_for(flights);
  request.effects.push_back(effect("lateral_damping"));
  return assemble(request, registry());
}

double value_of(const Model& model, const std::string& name) {
  return model.parameters.at(static_cast<std::size_t>(model.find_parameter(name))).value;
}

TEST(RunnableStarts, HaveDampingThenNoEffectsThenBoth) {
  Model model = with_lateral_damping({fly(5.0, 71)});
  set(model, "C_lateral", 3.0);
  std::vector<std::string> words;
  for (const RunnableStart& start : runnable_starts(model)) words.push_back(start.words);
  const std::string damped = "damping at its typical size", off = "C_lateral = 0";
  EXPECT_THAT(words, ElementsAre(damped, off, off + ", " + damped, off + ", " + damped)) << "its curves are 0";
  EXPECT_EQ(value_of(with_strengths_off(model).model, "C_lateral"), 0.0);
  EXPECT_EQ(value_of(model, "C_lateral"), 3.0);
}

TEST(RunnableStarts, LastHaveNoCurveThatPushes) {
  Model model = with_lateral_damping({fly(5.0, 71)});
  for (Parameter& p : model.parameters) {
    if (p.name.starts_with("C_m[")) p.value = 0.04;
  }
  const std::vector<RunnableStart> starts = runnable_starts(model);
  const std::string flat = "curves at 0", damped = flat + ", damping at its typical size";
  ASSERT_GE(starts.size(), 2U);
  EXPECT_EQ(starts[starts.size() - 2].words, flat);
  EXPECT_EQ(starts.back().words, damped);
  EXPECT_EQ(value_of(starts.back().model, "C_m[3]"), 0.0);
  EXPECT_LT(value_of(starts.back().model, "C_mq[3]"), 0.0);
}

TEST(RunnableStarts, AHeldStrengthStaysAsItIs) {
  Model model = with_lateral_damping({fly(5.0, 71)});
  set(model, "C_lateral", 3.0);
  model.parameters[static_cast<std::size_t>(model.find_parameter("C_lateral"))].free = false;
  EXPECT_TRUE(free_strengths(model).empty());
  EXPECT_EQ(value_of(with_strengths_off(model).model, "C_lateral"), 3.0);
}

TEST(EstimateFilter, AStartThatCannotBeRunIsReplacedAndThatIsSaid) {
  const std::vector<Signals> flights = {fly(12.0, 72)};
  Model start = with_lateral_damping(flights);
  const FilterEstimate known = estimate_filter(start, curve_penalties(start), flights);
  EXPECT_TRUE(known.notes.empty());
  set(start, "C_lateral", 40.0);  // a rotation about the axis of the flow grows without end
  const FilterEstimate found = estimate_filter(start, curve_penalties(start), flights);
  ASSERT_FALSE(found.notes.empty());
  EXPECT_THAT(found.notes.back(), HasSubstr("cannot be run from its start"));
  EXPECT_NEAR(found.objective, known.objective, 1.0);
  EXPECT_NEAR(value_of(found.model, "C_lateral"), value_of(known.model, "C_lateral"), 0.1);
}

TEST(EstimateFilter, AStartWhoseCurvesHoldTheMotionNowhereEndsAtTheSameMaximum) {
  const std::vector<Signals> flights = {fly(12.0, 72)};
  Model start = with_lateral_damping(flights);
  const FilterEstimate known = estimate_filter(start, curve_penalties(start), flights);
  for (Parameter& p : start.parameters) {
    if (p.name.starts_with("C_m[")) p.value = 0.04;
    if (p.name.starts_with("C_mq[")) p.value = 0.6;
  }
  set(start, "C_lateral", -1.2);
  const FilterEstimate found = estimate_filter(start, curve_penalties(start), flights);
  ASSERT_FALSE(found.notes.empty());
  EXPECT_THAT(found.notes.back(), HasSubstr("curves at 0"));
  EXPECT_NEAR(found.objective, known.objective, 1.0);
}

TEST(EstimateFilter, OfSeveralStartsTheHigherEndIsKept) {
  const std::vector<Signals> flights = {fly(12.0, 72)};
  const Model good = with_lateral_damping(flights);
  Model bad = good;
  set(bad, "C_lateral", 40.0);
  const FilterEstimate alone = estimate_filter(good, curve_penalties(good), flights);
  const FilterEstimate both = estimate_filter({{bad, curve_penalties(bad)}, {good, curve_penalties(good)}}, flights);
  EXPECT_GT(both.objective, alone.objective - 0.1);
  EXPECT_THAT(both.notes, testing::Not(testing::Contains(HasSubstr("cannot be run")))) << "one start could be run as it was";
}

}  // namespace
}  // namespace misfit
