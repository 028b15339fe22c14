#include "misfit/inference/identifiable.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "misfit/fit/regression/equation_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;
using testing::HasSubstr;

/// x' = b − a x + idle u under an input that stays 0, so that nothing depends on `idle`; its prior: 2 ± 0.1.
Model with_idle() {
  const auto known = registry_with(R"toml(
[states]
x = { unit = "V", scale = 1.0 }
[inputs]
u = { unit = "V" }
[parameters]
a = { unit = "1/s", value = 0.8, bounds = [0.0, 10.0], free = true }
b = { unit = "V/s", value = 0.1, free = true }
idle = { unit = "1/s", value = 2.0, free = true }
[equations]
x = "b - a*x + idle*u"
[outputs]
y = { unit = "V", formula = "x", noise = 0.01 }
)toml");
  ModelRequest request = request_of("text");
  request.parameters["idle"].sigma = 0.1;
  return assemble(request, *known);
}

std::vector<Signals> decaying() {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  Signals s;
  s.name = "record";
  s.measured = {{"y", "V", {}, 0.0}};
  s.inputs = {{"u", "V", std::vector<double>(100, 0.0), 0.0}};
  for (int i = 0; i < 100; ++i) {
    s.t.push_back(0.05 * i);
    s.measured[0].values.push_back(0.2 + std::exp(-s.t.back()) + 0.01 * normal(random));
  }
  return {s};
}

/// Residuals that depend on a + b times `together`, on a by itself, and not on `idle`.
NormalEquations problem_of(const Model& model, double together, double alone) {
  NormalEquations out;
  out.N = Eigen::Matrix3d::Zero();
  out.N.topLeftCorner(2, 2).setConstant(together);
  out.N(0, 0) += alone;
  out.g = Eigen::Vector3d::Zero();
  out.theta = model.theta();
  out.prior = parameter_priors(model);
  return out;
}

/// The prior knows it: it takes nothing from what the data say of the others.
TEST(Undetermined, AParameterThatOnlyItsPriorKnowsLeavesTheOthersDetermined) {
  const Model model = with_idle();
  EXPECT_EQ(undetermined(model, problem_of(model, 100.0, 1.0)), "");
  EXPECT_EQ(undetermined_beside_priors(model, problem_of(model, 100.0, 1.0), 1e-4), "");
  EXPECT_THAT(undetermined(model, problem_of(model, 100.0, 0.0)), HasSubstr("these data do not determine a and b separately"));
}

/// A prior of one of two parameters of which only the sum acts determines both, be the data in whatever unit.
TEST(Undetermined, APriorOfOneOfTwoThatActTogetherDeterminesBoth) {
  const Model model = with_idle();
  NormalEquations problem = problem_of(model, 1e12, 0.0);
  EXPECT_NE(undetermined(model, problem), "");
  problem.prior.precision[0] = 1e3;
  EXPECT_EQ(undetermined(model, problem), "");
}

TEST(Undetermined, AFitWithAParameterThatOnlyItsPriorKnowsSucceeds) {
  const Model model = with_idle();
  const FittedModel start = equation_error(model, decaying());
  EXPECT_THAT(start.fit.warnings, testing::Not(testing::Contains(HasSubstr("do not determine"))));
  const Fit fit = output_error(start, decaying()).fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_NEAR(fit.parameters.at("idle").sigma, 0.1, 1e-6);
  EXPECT_NEAR(fit.parameters.at("a").value, 1.0, 0.1);
}

}  // namespace
}  // namespace misfit
