// The regression of x' = -a x + b u, an input that is held between its steps.
#include "misfit/fit/regression/equation_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::HasSubstr;

/// a = b = 1/s, solved exactly from step to step; the input steps at every `every`-th sample of 0.05 s.
Signals record(int samples, int every) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "record";
  s.measured = {{"y", "V", {}, 0.0}};
  s.inputs = {{"u", "V", {}, 0.0}};
  double x = 1.0, u = 0.0;
  for (int i = 0; i < samples; ++i) {
    if (i % every == 0) u = 2.0 + normal(random);
    s.t.push_back(0.05 * i);
    s.measured[0].values.push_back(x + 1e-4 * normal(random));
    s.inputs[0].values.push_back(u);
    x = u + (x - u) * std::exp(-0.05);
  }
  return s;
}

/// `a`: what the text says of that parameter.
Fit regressed(const std::string& a, const Signals& signals) {
  const auto known = registry_with("[states]\nx = { unit = \"V\" }\n[inputs]\nu = { unit = \"V\", hold = \"zero_order\" }\n[parameters]\n" +
                                   std::string("a = { unit = \"1/s\", ") + a +
                                   " }\nb = { unit = \"1/s\", value = 0.1, bounds = [-5.0, 5.0], free = true }\n[equations]\n"
                                   "x = \"-a*x + b*u\"\n[outputs]\ny = { unit = \"V\", formula = \"x\", noise = 0.001 }\n");
  return equation_error(assemble(request_of("text"), *known), {signals}).fit;
}

/// A parameter that a bound holds: the others are what they are with it fixed there, not what they were beyond it.
TEST(EquationError, AtABoundTheOthersTakeTheirConditionalValues) {
  const Signals signals = record(600, 40);
  const Fit at_bound = regressed("value = 0.2, bounds = [0.0, 0.5], free = true", signals), held = regressed("value = 0.5", signals);
  ASSERT_EQ(at_bound.status, FitStatus::converged) << at_bound.message;
  EXPECT_EQ(at_bound.parameters.at("a").value, 0.5);
  EXPECT_NEAR(at_bound.parameters.at("b").value, held.parameters.at("b").value, 1e-3);
  EXPECT_LT(held.parameters.at("b").value, 0.8) << "1 beyond the bound";
  EXPECT_THAT(at_bound.warnings, testing::Contains(HasSubstr("a ends at its bound, 0.5")));
}

/// What a parameter explains beyond its bound is not explained by the estimate.
TEST(EquationError, AtABoundTheResidualsAreThoseOfTheEstimate) {
  const Signals signals = record(600, 40);
  const Fit at_bound = regressed("value = 0.2, bounds = [0.0, 0.5], free = true", signals), held = regressed("value = 0.5", signals);
  const double expected = held.noise.at("equation_residual").value;
  EXPECT_NEAR(at_bound.noise.at("equation_residual").value, expected, 1e-3 * expected);
}

/// The states of the first of two experiments are not known at any sample: what is said is of the second.
TEST(EquationError, AFirstExperimentThatShowsNothingIsPassedOver) {
  const auto known = registry_with(duffing_text);
  const Model model = assemble(request_of("text"), *known);
  Signals swing;
  swing.name = "swing";
  swing.measured = {{"y", "V", {}, 0.0}};
  swing.inputs = {{"u", "V", {}, 0.0}};
  for (int i = 0; i < 400; ++i) {
    swing.t.push_back(0.02 * i);
    swing.measured[0].values.push_back(0.1 * std::exp(-0.2 * swing.t.back()) * std::cos(5.5 * swing.t.back()));
    swing.inputs[0].values.push_back(0.0);
  }
  Signals nothing = swing;
  nothing.name = "nothing";
  nothing.measured[0].values.assign(swing.samples(), std::nan(""));
  const Fit both = equation_error(model, {nothing, swing}).fit, one = equation_error(model, {swing}).fit;
  ASSERT_EQ(both.status, FitStatus::converged) << both.message;
  EXPECT_EQ(both.facts.at("whiteness"), one.facts.at("whiteness"));
  EXPECT_EQ(both.warnings, one.warnings);
}

/// An input that steps every ten samples leaves nowhere the twenty residuals that are averaged.
TEST(EquationError, WhetherAForceDrivesItIsNotSaidWhereItCannotBeTested) {
  const Fit fit = regressed("value = 0.1, bounds = [-5.0, 5.0], free = true", record(600, 10));
  EXPECT_THAT(fit.facts.at("whiteness"), HasSubstr("not tested for a force"));
  EXPECT_FALSE(fit.driven);
  EXPECT_FALSE(fit.says_driven().has_value());
  EXPECT_TRUE(regressed("value = 0.1, bounds = [-5.0, 5.0], free = true", record(600, 40)).says_driven().has_value());
}

/// The state's kinks are no place for a local polynomial.
TEST(EquationError, TakesNoDerivativeAcrossAStepOfAHeldInput) {
  const std::string free = "value = 0.1, bounds = [-5.0, 5.0], free = true";
  const Fit apart = regressed(free, record(4000, 40));
  EXPECT_NEAR(apart.parameters.at("a").value, 1.0, 0.005);
  EXPECT_NEAR(apart.parameters.at("b").value, 1.0, 0.005);
  EXPECT_THAT(apart.warnings, testing::Not(testing::Contains(HasSubstr("steps at nearly every sample"))));
  EXPECT_THAT(regressed(free, record(4000, 1)).warnings, testing::Contains(HasSubstr("steps at nearly every sample")));
}

}  // namespace
}  // namespace misfit
