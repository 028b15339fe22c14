// An experiment of which no sample is in the estimation: what its initial state is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/inference/states.h"
#include "tests/fit/first_order.h"

namespace misfit {
namespace {

using namespace testing_first_order;
using testing::HasSubstr;
using testing::Not;

Signals held_out() {
  Signals s = record("test", 0.7, 3, 0.2);
  s.validation_from = -1.0;
  return s;
}

TEST(HeldOutExperiment, BeginsWithTheMemoryOfASensorAsRead) {
  const auto known = registry_with(one_output);
  ModelRequest request = request_of("text", {effect("sensor_lag", {{"output", "y"}})});
  request.parameters["share"].value = 1.0;
  request.parameters["share"].free = false;
  request.parameters["sensor_tau"].value = 0.05;
  request.parameters["sensor_tau"].free = false;
  const Model model = assemble(request, *known);
  const std::vector<Signals> experiments{record("fit", 1.0, 2), held_out()};
  const FittedModel fit = fitted(model, experiments);
  ASSERT_EQ(fit.fit.status, FitStatus::converged) << fit.fit.message;
  ASSERT_EQ(fit.initial_states.size(), 2U);
  const double read = reconstruct_states(model, experiments[1]).x.row(0)[1];
  EXPECT_NEAR(fit.initial_states[1][1], read, 1e-3);
  EXPECT_TRUE(fit.fit.validation_rms.contains("y"));
}

TEST(HeldOutExperiment, WithSharedInitialStatesBeginsAsTheOthersDo) {
  const auto known = registry_with(one_output);
  ModelRequest request = request_of("text");
  request.initial["x"] = {Initial::shared, std::nullopt, {}};
  const Model model = assemble(request, *known);
  Signals test = record("test", 0.7, 3, 0.5);
  test.validation_from = -1.0;
  const FittedModel fit = fitted(model, {test, record("fit", 1.0, 2)});
  ASSERT_EQ(fit.fit.status, FitStatus::converged) << fit.fit.message;
  EXPECT_NEAR(fit.initial_states[0][0], fit.initial_states[1][0], 1e-6);
  EXPECT_THAT(fit.fit.facts.at("held out: test"), Not(HasSubstr("first samples")));
}

/// Nothing shows w, so nothing tells where it began.
TEST(UndeterminedStart, OfAStateIsNamed) {
  std::string text = one_output;
  text.replace(text.find("[inputs]"), 8, "w = { unit = \"V\", scale = 1.0 }\n[inputs]");
  text.replace(text.find("[outputs]"), 9, "w = \"a*(u - w)\"\n[outputs]");
  const Fit fit = fitted(text, {record("one", 1.0, 2)}).fit;
  EXPECT_EQ(fit.status, FitStatus::failed);
  EXPECT_THAT(fit.message, HasSubstr("initial value of w in 'one'"));
}

}  // namespace
}  // namespace misfit
