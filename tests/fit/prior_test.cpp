#include "misfit/inference/prior.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "misfit/fit/regression/equation_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "misfit/inference/curves.h"
#include "misfit/math/decompositions.h"
#include "tests/fit/planar_model.h"
#include "tests/fit/room.h"

namespace misfit {
namespace {

std::vector<Signals> noisy_motion() {
  Signals signals = testing_planar::validation_signals("alpha_T_true");
  constexpr std::size_t samples = 1200;
  signals.t.resize(samples);
  for (auto& s : signals.measured) s.values.resize(samples);
  for (auto& s : signals.inputs) s.values.resize(samples);
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 0.1 * testing_planar::degree);
  for (double& v : signals.measured.front().values) v += noise(random);
  return {signals};
}

/// The damping curve's coefficients with a prior, if one is given.
Model model_of(const std::vector<Signals>& experiments, std::optional<double> mean = {}, std::optional<double> sigma = {}) {
  ModelRequest request = testing_planar::eq_8();
  for (auto& [name, curve] : request.curves) curve.knots.clear();
  if (mean) request.parameters["C_m_alphadot"].value = mean;
  if (sigma) request.parameters["C_m_alphadot"].sigma = sigma;
  choose_all_knots(request, testing_planar::registry(), experiments, 8);
  return assemble(request, testing_planar::registry());
}

TEST(RegularisedPriors, GiveWayWhereATypicalSizeIsFarTooSmall) {
  ModelRequest request = testing_planar::eq_8();
  request.effects.push_back(EffectRequest{"viscous_friction", "viscous_friction", {}, {}});
  const Model model = assemble(request, testing_planar::registry());
  const std::vector<int> free = model.free_parameters();
  const auto place = std::find(free.begin(), free.end(), model.find_parameter("viscosity")) - free.begin();
  ASSERT_EQ(model.parameters[static_cast<std::size_t>(model.find_parameter("viscosity"))].scale, 1.0);
  const auto precision = [&](double sigma_of_data) {
    Eigen::VectorXd information = Eigen::VectorXd::Zero(std::ssize(free));
    if (sigma_of_data > 0.0) information[place] = 1.0 / (sigma_of_data * sigma_of_data);
    return regularised_priors(model, information).precision[place];
  };
  EXPECT_DOUBLE_EQ(precision(0.1), 1e-6);
  EXPECT_DOUBLE_EQ(precision(50.0), 1e-6) << "a thousand typical sizes are wide enough";
  EXPECT_NEAR(precision(2e5), 1e-6 / 4e10, 1e-22) << "they would hold what the measurements know";
  EXPECT_DOUBLE_EQ(precision(0.0), 1e-6) << "of which nothing is measured";
}

/// Then the covariance is that of the prior, and no sigma of an estimate.
TEST(RegularisedPriors, WhatIsLeftToThemIsNamed) {
  const auto registry = testing_room::registry_with(testing_room::warming("tau", "2e4"));
  Model model = assemble(testing_room::request_of("text"), *registry);
  for (Parameter& p : model.parameters) p.scale = 0.1;
  const std::vector<int> free = model.free_parameters();
  ASSERT_EQ(free.size(), 2u);
  const auto left = [&](double sigma_of_data) {  // of the first; the second is known
    const Eigen::Vector2d information(1.0 / (sigma_of_data * sigma_of_data), 1.0);
    Eigen::Matrix2d precision = information.asDiagonal();
    precision.diagonal() += regularised_priors(model, information).precision;
    return left_to_wide_priors(model, information, inverse(precision));
  };
  EXPECT_EQ(left(1e9), std::vector<int>{free[0]}) << "1e10 typical sizes";
  EXPECT_TRUE(left(1e7).empty()) << "wide of what the measurements know";
  EXPECT_TRUE(left(0.01).empty());
  model.parameters[static_cast<std::size_t>(free[0])].prior_sigma = 1.0;
  EXPECT_TRUE(left(1e9).empty()) << "a prior that the study states";
}

/// Worked by hand. The data know the difference of two parameters and nothing of their sum: from (3, 1) the difference of 2 is kept, the
/// sum of 4 is not, so the prior is about (1, -1). Where they know both, it is about (3, 1) itself.
TEST(RegularisedPriors, AreAboutThePointWhereSomethingIsKnownAndAboutZeroElsewhere) {
  const auto registry = testing_room::registry_with(testing_room::warming("tau", "2e4"));
  Model model = assemble(testing_room::request_of("text"), *registry);
  ASSERT_EQ(model.free_parameters().size(), 2u);
  for (Parameter& p : model.parameters) p.scale = 1.0;
  const Eigen::Vector2d at(3.0, 1.0);
  const Eigen::Matrix2d difference = (Eigen::Matrix2d() << 4.0, -4.0, -4.0, 4.0).finished();
  const ColumnPriors half = regularised_priors_about(at, model, {}, difference);
  EXPECT_LT((half.mean - Eigen::Vector2d(1.0, -1.0)).norm(), 1e-5);
  EXPECT_LT((half.precision - Eigen::Vector2d::Constant(1e-6)).norm(), 1e-18);
  const ColumnPriors whole = regularised_priors_about(at, model, {}, difference + Eigen::Matrix2d::Identity());
  EXPECT_LT((whole.mean - at).norm(), 1e-9);
}

/// Values of the damping curve's coefficients.
Eigen::VectorXd damping_of(const Model& model) {
  const Curve& curve = *model.find_curve("C_m_alphadot");
  Eigen::VectorXd out(curve.spline.size());
  for (int i = 0; i < curve.spline.size(); ++i) out[i] = model.parameters[static_cast<std::size_t>(curve.first + i)].value;
  return out;
}

/// Worked by hand. A sigma of 0.05 about -0.2, at -0.1: -(0.1/0.05)^2/2 = -2, slope -0.1/0.0025 = -40. A penalty of 3 on (1, 2) with
/// omega = (2 -1; -1 2): c'Oc = 6, so -9 and a slope of -3 O c = (0, -9).
TEST(GaussianPrior, OfAWorkedExample) {
  Penalty penalty;
  penalty.first = 1;
  penalty.omega = (Eigen::Matrix2d() << 2.0, -1.0, -1.0, 2.0).finished();
  penalty.rank = 2;
  penalty.lambda = 3.0;
  const GaussianPrior prior{{Eigen::Vector3d(400.0, 0.0, 0.0), Eigen::Vector3d(-0.2, 0.0, 0.0)}, {penalty}};
  const Eigen::VectorXd theta = Eigen::Vector3d(-0.1, 1.0, 2.0);
  EXPECT_NEAR(prior.log_density(theta), -2.0 - 9.0, 1e-12);
  EXPECT_LT((prior.gradient(theta) - Eigen::Vector3d(-40.0, 0.0, -9.0)).norm(), 1e-12);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(3, 3);
  prior.add_precision(information);
  EXPECT_LT((information - (Eigen::Matrix3d() << 400.0, 0.0, 0.0, 0.0, 6.0, -3.0, 0.0, -3.0, 6.0).finished()).norm(), 1e-12);
  EXPECT_NEAR(penalty.log_normalisation(), 1.0986122886681098, 1e-15);  // ln 3
  Parameter parameter;
  parameter.value = -0.1;
  parameter.prior_mean = -0.2;
  parameter.prior_sigma = 0.05;
  EXPECT_NEAR(log_prior(parameter), -2.0, 1e-12);
}

TEST(GaussianPrior, GradientAndPrecisionAreDerivativesOfItsDensity) {
  const std::vector<Signals> experiments = noisy_motion();
  const Model model = model_of(experiments, -0.2, 0.05);
  std::vector<Penalty> penalties = curve_penalties(model);
  for (Penalty& p : penalties) p.lambda *= 3.0;
  const GaussianPrior prior{parameter_priors(model), penalties};
  Eigen::VectorXd theta = model.theta();
  for (Eigen::Index i = 0; i < theta.size(); ++i) theta[i] += 0.01 * std::sin(static_cast<double>(i));
  Eigen::MatrixXd precision = Eigen::MatrixXd::Zero(theta.size(), theta.size());
  prior.add_precision(precision);
  const Eigen::VectorXd gradient = prior.gradient(theta);
  constexpr double h = 1e-3;
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(theta.size(), i);
    const double slope = (prior.log_density(theta + step) - prior.log_density(theta - step)) / (2.0 * h);
    EXPECT_NEAR(gradient[i], slope, 1e-7 * gradient.norm()) << i;
    const Eigen::VectorXd bend = (prior.gradient(theta - step) - prior.gradient(theta + step)) / (2.0 * h);
    EXPECT_LT((precision.col(i) - bend).norm(), 1e-7 * precision.norm()) << i;
  }
}

TEST(GaussianPrior, RowsOfASolverAreItsDensity) {
  const std::vector<Signals> experiments = noisy_motion();
  const Model model = model_of(experiments, -0.2, 0.05);
  const GaussianPrior prior{parameter_priors(model), curve_penalties(model)};
  const Eigen::VectorXd theta = Eigen::VectorXd::LinSpaced(model.theta().size(), -1.0, 2.0);
  double squares = 0.0;
  for (const PriorRows& rows : prior_rows(prior))
    squares += (rows.L * (theta.segment(rows.first, rows.L.cols()) - rows.mean)).squaredNorm();
  EXPECT_NEAR(-0.5 * squares, prior.log_density(theta), 1e-10 * squares);
}

TEST(GaussianPrior, ThatOfAModelIsTheSumOverItsParameters) {
  const std::vector<Signals> experiments = noisy_motion();
  Model model = model_of(experiments, -0.2, 0.05);
  Eigen::VectorXd theta = model.theta();
  theta.array() += 0.03;
  model.set_theta(theta);
  double sum = 0.0;
  for (const Parameter& p : model.parameters) sum += p.free ? log_prior(p) : 0.0;
  EXPECT_LT(sum, -0.1);
  EXPECT_NEAR(log_prior(model, {}), sum, 1e-12);
}

/// A prior three times as tight as what the data say of the best known coefficient: its sigma bounds that of every one.
class SigmaOfACurve : public testing::Test {
 protected:
  void expect_prior_in(const FittedModel& fit) const {
    ASSERT_EQ(fit.fit.status, FitStatus::converged) << fit.fit.message;
    const Curve& curve = *fit.model.find_curve("C_m_alphadot");
    const std::vector<int> free = fit.model.free_parameters();
    const auto first = std::find(free.begin(), free.end(), curve.first) - free.begin();
    const Eigen::VectorXd variance = fit.fit.covariance.diagonal().segment(first, curve.spline.size());
    EXPECT_LT(std::sqrt(variance.maxCoeff()), 1.01 * sigma);
  }

  std::vector<Signals> experiments = noisy_motion();
  double mean = -0.2, sigma = 1e-3;
};

TEST_F(SigmaOfACurve, CountsInOutputError) {
  OutputErrorStart white;
  white.thorough = false;
  const FittedModel without = output_error(equation_error(model_of(experiments), experiments), experiments, white);
  ASSERT_EQ(without.fit.status, FitStatus::converged) << without.fit.message;
  mean = damping_of(without.model).mean();
  const Curve& curve = *without.model.find_curve("C_m_alphadot");
  const std::vector<int> free = without.model.free_parameters();
  const auto first = std::find(free.begin(), free.end(), curve.first) - free.begin();
  sigma = std::sqrt(without.fit.covariance.diagonal().segment(first, curve.spline.size()).minCoeff()) / 3.0;
  expect_prior_in(output_error(equation_error(model_of(experiments, mean, sigma), experiments), experiments, white));
}

TEST_F(SigmaOfACurve, CountsInEquationError) {
  const FittedModel without = equation_error(model_of(experiments), experiments);
  mean = damping_of(without.model).mean();
  FittedModel with = equation_error(model_of(experiments, mean, sigma), experiments);
  with.fit.covariance = with.plain_covariance;
  expect_prior_in(with);
}

}  // namespace
}  // namespace misfit
