#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "misfit/fit/regression/equation_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "misfit/inference/curves.h"
#include "misfit/inference/identifiable.h"
#include "tests/fit/planar_model.h"
#include "tests/fit/room.h"

namespace misfit {
namespace {

using testing::HasSubstr;

/// Static moment and damping with m_a free, all coefficients 0.02.
Model with_free_mass(std::optional<double> prior = {}) {
  ModelRequest request = testing_planar::eq_8();
  request.parameters["m_a"].free = true;
  request.parameters["m_a"].sigma = prior;
  if (prior) request.parameters["m_a"].value = 0.294;
  Model model = assemble(request, testing_planar::registry());
  for (auto& p : model.parameters) {
    if (p.curve >= 0) p.value = 0.02;
  }
  return model;
}

/// Every free parameter known to 3 % by itself.
Eigen::MatrixXd separate(const Model& model) {
  const std::vector<int> free = model.free_parameters();
  Eigen::VectorXd variance(static_cast<Eigen::Index>(free.size()));
  for (std::size_t c = 0; c < free.size(); ++c)
    variance[static_cast<Eigen::Index>(c)] = std::pow(0.03 * model.parameters[static_cast<std::size_t>(free[c])].value, 2);
  return variance.asDiagonal();
}

/// A common relative change of m_a and C_m (times `sign`) of 30 %.
Eigen::MatrixXd together(const Model& model, double sign) {
  const std::vector<int> free = model.free_parameters();
  Eigen::VectorXd u = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(free.size()));
  for (std::size_t c = 0; c < free.size(); ++c) {
    const Parameter& p = model.parameters[static_cast<std::size_t>(free[c])];
    if (p.name == "m_a") u[static_cast<Eigen::Index>(c)] = sign * 0.3 * p.value;
    if (p.curve >= 0 && model.curves[static_cast<std::size_t>(p.curve)].name == "C_m") u[static_cast<Eigen::Index>(c)] = 0.3 * p.value;
  }
  return u * u.transpose();
}

TEST(WeakDirections, AreSilentWhereEverythingIsKnownByItself) {
  const Model model = with_free_mass();
  Fit fit;
  warn_of_collinearity(model, separate(model), fit);
  EXPECT_TRUE(fit.warnings.empty());
  EXPECT_TRUE(fit.facts.empty());
}

TEST(WeakDirections, AParameterAndACurveThatActAsARatioAreSaidToDoSo) {
  const Model model = with_free_mass();
  for (const double sign : {1.0, -1.0}) {
    Fit fit;
    warn_of_collinearity(model, separate(model) + together(model, sign), fit);
    ASSERT_EQ(fit.warnings.size(), 1U);
    EXPECT_THAT(fit.warnings.front(),
                HasSubstr(std::string("m_a and the scale of C_m are nearly collinear: their ") + (sign > 0.0 ? "ratio" : "product")));
    EXPECT_THAT(fit.warnings.front(), HasSubstr("30 %"));
  }
}

TEST(WeakDirections, CollinearButWellKnownIsNotWorthSaying) {
  const Model model = with_free_mass();
  Fit fit;
  warn_of_collinearity(model, 0.01 * (separate(model) + together(model, 1.0)), fit);
  EXPECT_TRUE(fit.warnings.empty());
}

/// Several directions may be weak in the same parameters: that is one thing to say.
TEST(WeakDirections, TheSameGroupIsSaidOnce) {
  const Model model = with_free_mass();
  const std::vector<int> free = model.free_parameters();
  const auto n = static_cast<Eigen::Index>(free.size());
  const Eigen::VectorXd values = Eigen::VectorXd::NullaryExpr(
      n, [&](Eigen::Index c) { return model.parameters[static_cast<std::size_t>(free[static_cast<std::size_t>(c)])].value; });
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::size_t groups = 0;
  for (int k = 0; k < 50; ++k) {  // all known together to 30 %, and each beside the others much better
    const Eigen::VectorXd along = 0.3 * values;
    const Eigen::MatrixXd across = 0.003 * values.asDiagonal() * Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
    Fit fit;
    warn_of_collinearity(model, along * along.transpose() + across * across.transpose(), fit);
    groups += static_cast<std::size_t>(std::count_if(fit.warnings.begin(), fit.warnings.end(),
                                                     [](const std::string& w) { return w.find("are collinear") != std::string::npos; }));
    EXPECT_EQ(std::set<std::string>(fit.warnings.begin(), fit.warnings.end()).size(), fit.warnings.size());
  }
  EXPECT_GT(groups, 10U) << "or nothing was tested";
}

TEST(WeakDirections, AParameterThatOnlyItsPriorKnowsIsAFact) {
  const Model model = with_free_mass(0.0089);
  Fit fit;
  warn_of_collinearity(model, separate(model), fit);  // 3 % of 0.294 is 0.0088
  EXPECT_THAT(fit.facts["prior_only"], HasSubstr("m_a"));
}

TEST(WeakDirections, AParameterThatLeftItsPriorThoughTheDataTellLessOfItIsNoSuccess) {
  Model model = with_free_mass(0.0089);
  Parameter& mass = model.parameters[static_cast<std::size_t>(model.find_parameter("m_a"))];
  mass.prior_mean = mass.value - 0.02;
  Fit fit;
  fit.status = FitStatus::converged;
  reject_prior_conflicts(model, separate(model), fit);
  EXPECT_EQ(fit.status, FitStatus::failed);
  EXPECT_THAT(fit.message, testing::AllOf(HasSubstr("m_a has run to 0.294"), HasSubstr("kg"), HasSubstr("[geometry]")));
  Fit well_told;  // the data know it to a tenth of what the prior does: they may move it
  well_told.status = FitStatus::converged;
  reject_prior_conflicts(model, 0.01 * separate(model), well_told);
  EXPECT_EQ(well_told.status, FitStatus::converged);
}

/// A coefficient is no constant of [geometry].
TEST(WeakDirections, ACoefficientThatLeftItsPriorIsToBeFixedAmongTheParameters) {
  ModelRequest request = testing_planar::eq_8();
  request.effects.push_back(EffectRequest{"viscous_friction", "viscous_friction", {}, {}});
  request.parameters["viscosity"].value = 2.4;
  request.parameters["viscosity"].sigma = 1.0;
  Model model = assemble(request, testing_planar::registry());
  model.parameters[static_cast<std::size_t>(model.find_parameter("viscosity"))].prior_mean = 0.0;
  Fit fit;
  fit.status = FitStatus::converged;
  const auto n = static_cast<Eigen::Index>(model.free_parameters().size());
  reject_prior_conflicts(model, Eigen::MatrixXd::Identity(n, n), fit);
  EXPECT_EQ(fit.status, FitStatus::failed);
  EXPECT_THAT(fit.message, testing::AllOf(HasSubstr("[parameters] viscosity = { free = false }"), testing::Not(HasSubstr("[geometry]"))));
}

TEST(WeakDirections, WithoutACurveAPriorThatTheDataContradictIsAWarning) {
  const auto known = testing_room::registry_with(testing_room::warming("tau", "2e4"));
  ModelRequest request = testing_room::request_of("text");
  request.parameters["rest"].sigma = 1.0;
  Model model = assemble(request, *known);
  model.parameters[static_cast<std::size_t>(model.find_parameter("rest"))].prior_mean = 15.0 - 2.4;
  Fit fit;
  fit.status = FitStatus::converged;
  reject_prior_conflicts(model, 0.64 * Eigen::Matrix2d::Identity(), fit);
  EXPECT_EQ(fit.status, FitStatus::converged);
  EXPECT_THAT(fit.warnings,
              testing::ElementsAre(testing::AllOf(HasSubstr("these data and the prior of rest disagree"), HasSubstr("12.6"))));
}

TEST(WeakDirections, AParameterAtItsBoundIsNamedWithItsBound) {
  Model model = with_free_mass();
  Parameter& mass = model.parameters[static_cast<std::size_t>(model.find_parameter("m_a"))];
  mass.lower = mass.value;
  Fit fit;
  warn_of_collinearity(model, separate(model), fit);
  EXPECT_THAT(fit.warnings, testing::ElementsAre(HasSubstr("m_a ends at its bound, 0.294 kg")));
  EXPECT_EQ(fit.doubts, std::vector<std::string>{"m_a ends at its bound, 0.294 kg"});
  const Eigen::MatrixXd covariance = separate(model);
  mass.lower = mass.value = 0.0;
  Fit not_needed;
  warn_of_collinearity(model, covariance, not_needed);
  EXPECT_THAT(not_needed.warnings, testing::Contains(HasSubstr("m_a ends at its bound, 0 kg")));
  EXPECT_FALSE(not_needed.doubts.has_value());
}

TEST(WeakDirections, ALagThatVanishesBesideAnEffectWithALongerOneIsNoDoubt) {
  const auto known = testing_room::registry_with(testing_room::warming("tau", "0.001"));
  Model model = assemble(testing_room::request_of("text", {testing_room::effect("sensor_lag", {{"output", "y"}})}), *known);
  Parameter& tau = model.parameters[static_cast<std::size_t>(model.find_parameter("tau"))];
  tau.lower = tau.value;
  Fit fit;
  warn_of_collinearity(model, separate(model), fit);
  EXPECT_THAT(fit.warnings, testing::Contains(testing::AllOf(HasSubstr("tau ends at its bound, 0.001 s"),
                                                             HasSubstr("sensor_lag takes the place of this lag"))));
  EXPECT_FALSE(fit.doubts.has_value());
  tau.lower = tau.value = 100.0;
  Fit slow;
  warn_of_collinearity(model, separate(model), slow);
  EXPECT_EQ(slow.doubts, std::vector<std::string>{"tau ends at its bound, 100 s"}) << "the model's lag has not vanished";
}

TEST(WeakDirections, AShapeOfEitherSignIsJudgedByItsTypicalSizeNotByItsNearnessToZero) {
  Model model = with_free_mass();
  const Eigen::MatrixXd covariance = separate(model);  // sigma 0.0088
  Parameter& shape = model.parameters[static_cast<std::size_t>(model.find_parameter("m_a"))];
  shape.kind = CoefficientKind::shape;
  shape.value = 0.001;
  shape.scale = 1.0;
  Fit positive, either;
  shape.lower = 0.0;
  warn_of_collinearity(model, covariance, positive);
  EXPECT_THAT(positive.warnings, testing::ElementsAre(HasSubstr("m_a is hardly determined by these data: 0.0010 ± 0.0088 kg")));
  shape.lower = -3.0;
  warn_of_collinearity(model, covariance, either);
  EXPECT_TRUE(either.warnings.empty());
  Fit large;
  shape.value = 0.5;
  shape.scale = 0.001;  // the library knows no size of it
  warn_of_collinearity(model, covariance, large);
  EXPECT_TRUE(large.warnings.empty()) << "0.5 ± 0.0088";
}

TEST(WeakDirections, AValueLostInItsSigmaIsKnownToSoMuchNotToAShareOfItself) {
  Model model = with_free_mass();
  const Eigen::MatrixXd covariance = separate(model) + together(model, 1.0);
  model.parameters[static_cast<std::size_t>(model.find_parameter("m_a"))].value = 0.0;
  Fit fit;
  warn_of_collinearity(model, covariance, fit);
  ASSERT_FALSE(fit.warnings.empty());
  EXPECT_THAT(fit.warnings.front(), testing::AllOf(HasSubstr("are correlated"), HasSubstr("± 0.08864 kg")));
}

TEST(WeakDirections, MassBesideAFreeStaticCurveIsNamedByTheFit) {
  const std::vector<Signals> experiments{testing_planar::validation_signals()};
  ModelRequest request = testing_planar::eq_8();
  request.curves.clear();
  choose_all_knots(request, testing_planar::registry(), experiments, 8);
  const Model model = assemble(request, testing_planar::registry());
  FittedModel start = output_error(equation_error(model, experiments), experiments);
  ASSERT_EQ(start.fit.status, FitStatus::converged) << start.fit.message;
  const std::vector<std::string> before = start.fit.warnings;
  EXPECT_THAT(before, testing::Not(testing::Contains(HasSubstr("nearly collinear"))));
  Parameter& mass = start.model.parameters[static_cast<std::size_t>(start.model.find_parameter("m_a"))];
  mass.free = true;
  mass.prior_mean = mass.value;
  mass.prior_sigma = 0.03;
  const Fit fit = output_error(start, experiments).fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_THAT(fit.warnings, testing::Contains(testing::AllOf(HasSubstr("m_a"), HasSubstr("the scale of C_m"))));
  EXPECT_THAT(fit.facts.at("prior_only"), HasSubstr("m_a"));
}

}  // namespace
}  // namespace misfit
