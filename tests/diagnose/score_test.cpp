#include "misfit/diagnose/score.h"

#include <gtest/gtest.h>

#include "misfit/diagnose/features.h"
#include "misfit/math/decompositions.h"
#include "misfit/math/statistics.h"
#include "tests/fit/cart_filter.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_cart;
using testing_models::registry_with;
using testing_models::request_of;

/// An estimate that is nothing but linear least squares: residuals and derivatives of one free parameter.
FilterEstimate linear_estimate(const Eigen::VectorXd& r, const Eigen::VectorXd& column) {
  FilterEstimate estimate;
  estimate.model = assemble(cart({}), registry());
  estimate.model.parameters[0].free = true;
  FilterJacobian jacobian;
  jacobian.J = column;
  jacobian.r = r;
  estimate.jacobians = {jacobian};
  return estimate;
}

TEST(ScoreTest, Chi2IsChi2WhereNothingIsMissing) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  constexpr int trials = 400, rows = 60;
  double sum = 0.0;
  int beyond = 0;
  for (int k = 0; k < trials; ++k) {
    const auto draw = [&] { return normal(random); };
    const Eigen::VectorXd column = Eigen::VectorXd::NullaryExpr(rows, draw), r = Eigen::VectorXd::NullaryExpr(rows, draw);
    Eigen::MatrixXd C = Eigen::MatrixXd::NullaryExpr(rows, 3, draw);
    C.col(0) += 5.0 * column;  // mostly what the model has already
    const ScoreResult result = ScoreTest(linear_estimate(r, column)).test(C);
    ASSERT_EQ(result.dof, 3);
    sum += result.chi2;
    beyond += chi_square_tail(result.chi2, 3) < 0.05 ? 1 : 0;
  }
  EXPECT_NEAR(sum / trials, 3.0, 4.0 * std::sqrt(6.0 / trials));
  EXPECT_NEAR(beyond / static_cast<double>(trials), 0.05, 4.0 * std::sqrt(0.05 * 0.95 / trials));
}

TEST(ScoreTest, IsTheLeastSquaresAnswerForWhatIsAdded) {
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return normal(random); };
  const Eigen::VectorXd column = Eigen::VectorXd::NullaryExpr(40, draw);
  const Eigen::MatrixXd C = Eigen::MatrixXd::NullaryExpr(40, 2, draw);
  const Eigen::VectorXd r = Eigen::VectorXd::NullaryExpr(40, draw) - C * Eigen::Vector2d(2.0, -1.0);
  const ScoreTest score(linear_estimate(r, column));
  const ScoreResult result = score.test(C);
  Eigen::MatrixXd all(40, 3);
  all << column, C;
  const Eigen::VectorXd best = least_squares(all, -r), alone = least_squares(column, -r);
  EXPECT_NEAR(result.amplitude[0], best[1], 1e-6);
  EXPECT_NEAR(result.amplitude[1], best[2], 1e-6);
  EXPECT_NEAR(result.chi2, (r + column * alone).squaredNorm() - (r + all * best).squaredNorm(), 1e-4);
  EXPECT_NEAR(score.adjusted_step(C, result.amplitude)[0], best[0], 1e-5);
  const Eigen::MatrixXd inverse = misfit::inverse(all.transpose() * all);
  EXPECT_NEAR(result.sigma[0], std::sqrt(inverse(1, 1)), 1e-6);
  EXPECT_LT((result.covariance - inverse.bottomRightCorner(2, 2)).norm(), 1e-6);
  EXPECT_LT((column.transpose() * score.projected(C)).norm(), 1e-3);
}

TEST(ScoreTest, AColumnTheModelHasIsKnownAsSuch) {
  std::mt19937_64 random(13);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return normal(random); };
  const Eigen::VectorXd column = Eigen::VectorXd::NullaryExpr(50, draw), r = Eigen::VectorXd::NullaryExpr(50, draw);
  const Eigen::MatrixXd C = column + 0.02 * Eigen::VectorXd::NullaryExpr(50, draw);
  EXPECT_LT(ScoreTest(linear_estimate(r, column)).test(C).independent, 0.01);
}

/// Two columns that differ from the free parameter's in the same direction by little, and one that has nothing to do with it.
TEST(ScoreTest, OfWhatTheParametersNearlyDescribeThereIsNoAmplitudeBelowTheLeastShare) {
  std::mt19937_64 random(14);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return normal(random); };
  constexpr int rows = 500;
  constexpr double little = 0.05;
  const Eigen::VectorXd column = Eigen::VectorXd::NullaryExpr(rows, draw), beside = Eigen::VectorXd::NullaryExpr(rows, draw);
  Eigen::MatrixXd C(rows, 2);
  C << column + little * beside, Eigen::VectorXd::NullaryExpr(rows, draw);
  const Eigen::VectorXd r = Eigen::VectorXd::NullaryExpr(rows, draw) - beside - C.col(1);
  const ScoreTest score(linear_estimate(r, column));
  const ScoreResult all = score.test(C), seen = score.test(C, nullptr, 0.01);
  EXPECT_NEAR(all.amplitude[0], 1.0 / little, 4.0) << "many times what acts";
  EXPECT_EQ(seen.chi2, all.chi2) << "it is significant all the same";
  EXPECT_EQ(seen.dof, 2);
  EXPECT_LT(std::abs(seen.amplitude[0]), 0.1 * all.amplitude[0]);
  EXPECT_NEAR(seen.amplitude[1], 1.0, 4.0 / std::sqrt(rows));
}

TEST(ScoreTest, PriorsPullTheAmplitude) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(4), r = Eigen::VectorXd::Constant(4, -1.0);
  const Eigen::MatrixXd C = Eigen::MatrixXd::Ones(4, 1);
  const ColumnPriors priors{Eigen::VectorXd::Constant(1, 4.0), Eigen::VectorXd::Constant(1, 3.0)};
  const ScoreResult result = ScoreTest(linear_estimate(r, none)).test(C, &priors);
  EXPECT_NEAR(result.amplitude[0], 2.0, 1e-12) << "half way between the data's 1 and the prior's 3";
}

/// A force of one unit over every step is what a constant effect adds.
TEST(ForceSensitivity, OfAConstantIsTheColumnOfAConstantForce) {
  Cart cart(80, 5, {effect("own_weight")});
  for (auto& p : cart.model.model.parameters) p.free = p.name == "share";
  FilterJacobian jacobian;
  FilterEstimate estimate;
  estimate.traces = {cart.run(&jacobian)};
  estimate.model = assemble(testing_models::cart({effect("own_weight")}), registry());
  estimate.forced = cart.model;
  estimate.noise = cart.noise;
  estimate.data = {cart.data};
  estimate.jacobians = {jacobian};
  const ForceSensitivity force(estimate);
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(80, 1);
  const Eigen::MatrixXd columns = force.columns(0, ones, ones);
  ASSERT_EQ(columns.rows(), jacobian.J.rows());
  const double weight = 2.0 * 9.80665;
  EXPECT_LT((weight * columns - jacobian.J).norm(), 1e-8 * jacobian.J.norm());
  // The score of single steps adds up to that of the constant force.
  EXPECT_NEAR(force.score_of_steps(PortKind::dynamic, 0).sum(), -columns.col(0).dot(jacobian.r), 1e-6 * columns.norm() * jacobian.r.norm());
}

/// Of a parameter that stands in an equation and in an output: a change of one unit over every step and at every sample is the parameter's
/// own column.
TEST(ForceSensitivity, OfAConstantChangeIsTheColumnOfTheParameter) {
  const auto systems = registry_with(R"toml(
[states]
x = { unit = "m", scale = 1.0 }
[inputs]
u = { unit = "m/s" }
[parameters]
k = { unit = "1/m/s", value = 0.5, bounds = [0.0, 9.0], free = true }
delay = { unit = "s", value = 0.1 }
[equations]
x = "u - k*x*abs(x)"
[outputs]
y = { unit = "m", noise = 0.05, formula = "x + delay*k*x^2" }
)toml");
  Signals s;
  s.name = "run";
  s.measured = {{"y", "m", {}, 0.0}};
  s.inputs = {{"u", "m/s", {}, 0.0}};
  for (int n = 0; n < 200; ++n) {
    s.t.push_back(0.1 * n);
    s.inputs[0].values.push_back(1.0 + std::sin(0.07 * n));
    s.measured[0].values.push_back(1.3 + 0.6 * std::sin(0.07 * n - 0.5) + 0.05 * std::cos(2.3 * n * n));
  }
  const std::vector<Signals> recordings = {s};
  FilterOptions options;
  options.verify = false;
  const FilterEstimate estimate = estimate_filter(assemble(request_of("text"), *systems), {}, recordings, options);
  const int k = index_of(estimate.model.system->spec().quantity_ports, "k");
  ASSERT_GE(k, 0);
  const ForceSensitivity force(estimate, {k});
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(200, 1);
  const Eigen::VectorXd own = estimate.jacobians.at(0).J.col(0), column = force.columns_at(PortKind::quantity, 0, ones, ones).col(0);
  ASSERT_EQ(own.size(), column.size());
  EXPECT_GT(own.norm(), 1.0);
  EXPECT_LT((own - column).norm(), 1e-6 * own.norm());
}

ParameterRequest start(double value, bool free) {
  ParameterRequest out;
  out.value = value;
  out.free = free;
  return out;
}

FilterEstimate fitted(const std::vector<Signals>& recordings, const EffectRequest& added,
                      const std::map<std::string, ParameterRequest>& parameters) {
  ModelRequest request = cart({added});
  request.parameters = parameters;
  FilterOptions options;
  options.verify = false;
  return estimate_filter(assemble(request, registry()), {}, recordings, options);
}

/// The only free parameter's column in the whitened derivatives.
Eigen::VectorXd free_column(const FilterEstimate& estimate) { return estimate.jacobians.at(0).J.col(0); }

TEST(ForceSensitivity, OfAConstantErrorIsTheColumnOfABias) {
  const std::vector<Signals> recordings = {Cart(300).signals};
  const FilterEstimate estimate = fitted(recordings, effect("bias", {{"output", "speed_reading"}}), {{"offset", start(0.0, true)}});
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(300, 1);
  const Eigen::MatrixXd columns = ForceSensitivity(estimate).output_columns(1, ones, ones);
  EXPECT_LT((columns - free_column(estimate)).norm(), 1e-8 * columns.norm());
}

/// An error must not depend on the measurement that it is looked for in: it is that of the state predicted by the sample before.
TEST(ForceSensitivity, OfAnErrorGoesWithThePredictionOfTheSampleBefore) {
  const std::vector<Signals> recordings = {Cart(60).signals};
  const FilterEstimate estimate = fitted(recordings, effect("bias", {{"output", "speed_reading"}}), {{"offset", start(0.0, true)}});
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(60, 1);
  Eigen::MatrixXd ahead = none;
  constexpr Eigen::Index k = 20;
  ahead(k, 0) = 1.0;
  const Eigen::VectorXd column = ForceSensitivity(estimate).output_columns(1, none, ahead);
  const FilterTrace& trace = estimate.traces.front();
  const Eigen::Index outputs = 2, uncounted = 60 * outputs - column.size(), next = (k + 1) * outputs + 1;
  const Eigen::Index row = next - uncounted;  // the first samples make the start
  ASSERT_EQ(uncounted, outputs);
  EXPECT_EQ(column.head(row).norm(), 0.0);
  EXPECT_NEAR(std::abs(column[row]), 1.0 / std::sqrt(trace.S[next]), 1e-12);
  EXPECT_GT(column.tail(column.size() - row - 1).norm(), 0.0) << "through the gains";
}

/// Hats reproduce what lies between their outer centres: the value is the sum of their centres by weight.
TEST(Features, OfThePastOfAnInputAreWhatIsLeftOfItsLastSteps) {
  std::vector<Signals> recordings = {Cart(1200).signals};
  std::vector<double>& u = recordings[0].inputs[0].values;
  constexpr std::size_t held = 100;
  for (std::size_t k = 0; k < u.size(); ++k) u[k] = (k / held) % 2 == 0 ? -1.0 : 1.0;
  const FilterEstimate estimate = fitted(recordings, effect("bias", {{"output", "speed_reading"}}), {{"offset", start(0.0, true)}});
  const std::vector<Features> pasts = features_of_pasts(estimate, ForceSensitivity(estimate), 8);
  ASSERT_EQ(pasts.size(), 2U) << "what follows within 2 samples is over before 25 of them lie under a third hat";
  const Features& past = pasts.back();  // tau: 32 samples
  EXPECT_EQ(past.quantity, "the past of drive");
  const Eigen::VectorXd centres = Eigen::Map<const Eigen::VectorXd>(past.centre.data(), std::ssize(past.centre));
  const Eigen::VectorXd at = past.f * centres, ahead = past.ahead * centres;
  // In steady state z swings between ±z0, and a step leaves 1 + z0 of u - z, less by exp(-1/32) at each sample.
  const double keep = std::exp(-1.0 / 32.0), whole = std::exp(-100.0 / 32.0), z0 = (1.0 - whole) / (1.0 + whole);
  for (const std::size_t since : {5U, 20U, 60U}) {
    EXPECT_NEAR(at[900 + since], (1.0 + z0) * std::pow(keep, since) * (900 / held % 2 == 0 ? -1.0 : 1.0), 0.01) << since;
    EXPECT_NEAR(ahead[900 + since], at[901 + since], 1e-9) << "the input is known before";
  }
}

/// dz/dt = (u - z)/tau, by tau: -(dz/dt)/tau.
TEST(ForceSensitivity, OfTheRateOfALagIsTheColumnOfItsTimeConstant) {
  const std::vector<Signals> recordings = {Cart(300).signals};
  const FilterEstimate estimate = fitted(recordings, effect("input_lag", {{"input", "drive"}, {"port", "force"}}),
                                         {{"lagged_gain", start(5.0, false)}, {"input_tau", start(0.3, true)}});
  const ForceSensitivity force(estimate);
  const double tau = estimate.model.parameters[estimate.model.find_parameter("input_tau")].value;
  const Eigen::MatrixXd columns = force.own_rate_columns(0, -force.own_rates() / tau);
  EXPECT_LT((columns - free_column(estimate)).norm(), 0.02 * columns.norm()) << "to second order in h/tau = 0.07";
}

}  // namespace
}  // namespace misfit
