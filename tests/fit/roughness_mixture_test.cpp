#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "misfit/inference/curve_freedom.h"
#include "misfit/inference/roughness.h"
#include "misfit/math/bspline.h"
#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

/// Measurements of a curve with unit noise at equal distances over its knots.
struct CurveMeasurements {
  CubicSpline spline;
  Eigen::MatrixXd A;
};

CurveMeasurements measurements() {
  std::vector<double> knots;
  for (int i = 0; i <= 14; ++i) knots.push_back(static_cast<double>(i));
  CurveMeasurements out{CubicSpline(knots), {}};
  constexpr Eigen::Index n = 150;
  out.A = Eigen::MatrixXd::Zero(n, out.spline.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    const CurvePoint p = out.spline.at(14.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
    for (int j = 0; j < 4; ++j) out.A(i, p.first + j) = p.w[static_cast<std::size_t>(j)];
  }
  return out;
}

NormalEquations problem_of(const CurveMeasurements& r, const Eigen::VectorXd& y) {
  NormalEquations out;
  out.N = r.A.transpose() * r.A;
  out.theta = Eigen::VectorXd::Zero(r.A.cols());
  out.g = -r.A.transpose() * y;
  out.rss = y.squaredNorm();
  out.count = static_cast<double>(y.size());
  out.prior = {Eigen::VectorXd::Constant(r.A.cols(), 1e-12), Eigen::VectorXd::Zero(r.A.cols())};
  return out;
}

Penalty penalty_of(const CurveMeasurements& r, double lambda, bool chosen) {
  Penalty p;
  p.omega = r.spline.roughness();
  p.rank = r.spline.size() - 2;
  p.lambda = lambda;
  p.chosen = chosen;
  return p;
}

/// Moves the problem to its maximum, where with_uncertain_roughness() wants it.
NormalEquations at_maximum(const NormalEquations& problem, const PenalisedFit& smoothed) {
  NormalEquations out = problem;
  out.theta = smoothed.theta;
  out.g = problem.g + problem.N * smoothed.theta;
  return out;
}

TEST(UncertainRoughness, AGivenRoughnessLeavesTheCovarianceAsItIs) {
  const CurveMeasurements r = measurements();
  const NormalEquations problem = problem_of(r, Eigen::VectorXd::LinSpaced(r.A.rows(), -3.0, 3.0));
  std::vector<Penalty> penalties{penalty_of(r, 10.0, false)};
  const PenalisedFit smoothed = estimate_smoothing(problem, penalties, 1.0);
  const Eigen::MatrixXd E = 0.5 * problem.N;
  const Eigen::MatrixXd found = with_uncertain_roughness(at_maximum(problem, smoothed), penalties, 1.0, E);
  const Eigen::MatrixXd expected = smoothed.covariance + smoothed.covariance * E * smoothed.covariance;
  EXPECT_LT((found - expected).norm(), 1e-9 * expected.norm());
}

/// Curves drawn from what the penalty says of them, the size of C'' uniform from nothing to what shows well: bands that take the chosen
/// weight for known are too narrow, those that do not hold what they say.
TEST(UncertainRoughness, BandsHoldWhatTheySay) {
  const CurveMeasurements r = measurements();
  const SymmetricEigen eigen = symmetric_eigen(r.spline.roughness());
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> size(0.0, 0.2);
  int inside = 0, inside_known = 0, all = 0;
  constexpr int draws = 300;
  for (int draw = 0; draw < draws; ++draw) {
    const double tau = size(random);
    Eigen::VectorXd c = Eigen::VectorXd::Zero(r.A.cols());
    for (Eigen::Index i = 2; i < c.size(); ++i) c += eigen.vectors.col(i) * normal(random) * tau / std::sqrt(eigen.values[i]);
    Eigen::VectorXd y = r.A * c;
    for (double& measurement : y) measurement += normal(random);
    const NormalEquations problem = problem_of(r, y);
    std::vector<Penalty> penalties{penalty_of(r, 1.0 / (tau * tau), true)};
    const PenalisedFit smoothed = estimate_smoothing(problem, penalties, 1.0);
    ASSERT_TRUE(smoothed.ok);
    const Eigen::MatrixXd covariance = with_uncertain_roughness(at_maximum(problem, smoothed), penalties, 1.0);
    for (const Eigen::Index i : {20, 50, 75, 110, 140}) {
      const Eigen::VectorXd row = r.A.row(i);
      const double error = std::abs(row.dot(smoothed.theta - c));
      inside += error < 1.96 * std::sqrt(row.dot(covariance * row)) ? 1 : 0;
      inside_known += error < 1.96 * std::sqrt(row.dot(smoothed.covariance * row)) ? 1 : 0;
      ++all;
    }
  }
  const double share = 100.0 * inside / all, known = 100.0 * inside_known / all;
  std::printf("95 %% bands hold %.1f %%, with the chosen weight taken for known %.1f %%\n", share, known);
  EXPECT_GT(share, 93.0);
  EXPECT_LT(share, 98.0);
  EXPECT_LT(known, share - 1.0);
}

/// Where the data show a straight line the weight runs away and the plain band is that of a line.
TEST(UncertainRoughness, AStraightLineKeepsTheBandOfTheBendsItMayHave) {
  const CurveMeasurements r = measurements();
  // Noise turned sign by sign: nothing in it bends.
  Eigen::VectorXd y(r.A.rows());
  for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = i % 2 == 0 ? 1.0 : -1.0;
  const NormalEquations problem = problem_of(r, y);
  std::vector<Penalty> penalties{penalty_of(r, 1.0, true)};
  const PenalisedFit smoothed = estimate_smoothing(problem, penalties, 1.0);
  ASSERT_LT(smoothed.edf, 2.2);
  const Eigen::MatrixXd covariance = with_uncertain_roughness(at_maximum(problem, smoothed), penalties, 1.0);
  const Eigen::VectorXd middle = r.A.row(75);
  EXPECT_GT(middle.dot(covariance * middle), 1.2 * middle.dot(smoothed.covariance * middle));
  EXPECT_LT(middle.dot(covariance * middle), 9.0 * middle.dot(smoothed.covariance * middle));
}

constexpr double wide = 1e-8;  // precision of each coefficient beside the roughness

/// Log density of the measurements, curve integrated out, but for what does not depend on λ: y ~ N(0, I + A P⁻¹ Aᵀ), P = λ Ω + `wide`.
double log_density(const CurveMeasurements& r, const Eigen::VectorXd& y, const Penalty& penalty) {
  Eigen::MatrixXd prior = penalty.lambda * penalty.omega;
  prior.diagonal().array() += wide;
  const Eigen::MatrixXd V = Eigen::MatrixXd::Identity(y.size(), y.size()) + r.A * symmetric_solve(prior, Eigen::MatrixXd(r.A.transpose()));
  return -cholesky(V).value().diagonal().array().log().sum() - 0.5 * y.dot(symmetric_solve(V, y));
}

TEST(RoughnessPaths, AreTheFitsThatAnotherRoughnessGives) {
  const CurveMeasurements r = measurements();
  Eigen::VectorXd y(r.A.rows());
  for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = 4.0 * std::sin(0.05 * static_cast<double>(i)) + (i % 2 == 0 ? 1.0 : -1.0);
  NormalEquations problem = problem_of(r, y);
  problem.prior.precision.setConstant(wide);
  std::vector<Penalty> penalties{penalty_of(r, 1.0, true)};
  penalties[0].curve = 3;
  static_cast<void>(estimate_smoothing(problem, penalties, 1.0));
  penalties[0].chosen = false;
  const PenalisedFit smoothed = estimate_smoothing(problem, penalties, 1.0);
  penalties[0].chosen = true;
  const auto paths = roughness_paths(at_maximum(problem, smoothed), penalties, 1.0);
  ASSERT_EQ(paths.size(), 1U);
  EXPECT_EQ(paths[0].curve, 3);
  EXPECT_EQ(paths[0].used, penalties[0].lambda);
  EXPECT_TRUE(paths[0].chosen);
  ASSERT_EQ(paths[0].lambda.size(), 25U);
  const double here = log_density(r, y, penalties[0]);
  for (std::size_t i = 0; i < paths[0].lambda.size(); ++i) {
    std::vector<Penalty> other{penalty_of(r, paths[0].lambda[i], false)};
    const PenalisedFit refitted = estimate_smoothing(problem, other, 1.0);
    EXPECT_LT((paths[0].theta[i] - refitted.theta).norm(), 1e-6 * refitted.theta.norm()) << i;
    EXPECT_NEAR(paths[0].log_likelihood[i], log_density(r, y, other[0]) - here, 1e-2) << i;
    EXPECT_LE(paths[0].log_likelihood[i], 1e-3) << "the chosen one is the most likely";
  }
  EXPECT_EQ(paths[0].theta[12], smoothed.theta);
  EXPECT_GT((paths[0].theta.front() - smoothed.theta).norm(), 0.05 * smoothed.theta.norm()) << "the test sees a difference";
}

/// Against the trace over all columns by estimate_smoothing(), of which two curves side by side have their shares.
TEST(CurveFreedom, IsTheShareOfTheCurveInTheEffectiveParameters) {
  const CurveMeasurements r = measurements();
  const Eigen::Index n = r.A.cols();
  Eigen::VectorXd y(r.A.rows());
  for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = 4.0 * std::sin(0.05 * static_cast<double>(i));
  const NormalEquations one = problem_of(r, y);
  for (const double lambda : {1e-6, 1.0, 1e6, 1e18}) {
    std::vector<Penalty> penalties{penalty_of(r, lambda, false)};
    const double edf = estimate_smoothing(one, penalties, 1.0).edf;
    ASSERT_EQ(curve_freedom(one, penalties, 1.0).size(), 1U);
    EXPECT_NEAR(curve_freedom(one, penalties, 1.0).front(), edf, 1e-6 * edf) << lambda;
  }
  NormalEquations two = one;
  two.N = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  two.N.topLeftCorner(n, n) = two.N.bottomRightCorner(n, n) = one.N;
  two.prior = ColumnPriors{}.padded(2 * n);
  std::vector<Penalty> both{penalty_of(r, 1e-6, false), penalty_of(r, 1e12, false)};
  both[1].first = static_cast<int>(n);
  const std::vector<double> freedom = curve_freedom(two, both, 1.0);
  ASSERT_EQ(freedom.size(), 2U);
  EXPECT_NEAR(freedom[0], curve_freedom(one, {both[0]}, 1.0).front(), 1e-6);
  EXPECT_NEAR(freedom[1], 2.0, 1e-3) << "a straight line";
  EXPECT_GT(freedom[0], 2.5);
}

TEST(RoughnessPaths, AreNoneWhereTheRoughnessIsZero) {
  const CurveMeasurements r = measurements();
  const NormalEquations problem = problem_of(r, Eigen::VectorXd::Ones(r.A.rows()));
  EXPECT_TRUE(roughness_paths(problem, {penalty_of(r, 0.0, false)}, 1.0).empty());
  EXPECT_TRUE(roughness_paths(problem, {}, 1.0).empty());
}

/// A curve so stiff that it is a line, beside a parameter that is known a million times less well than the line and almost stands in for
/// it: all that is known of both is what a line in its place would give, written down with two columns.
struct StiffBesideWeak {
  CurveMeasurements r = measurements();
  Eigen::MatrixXd X, line;  ///< columns of curve and parameter; of the line's two numbers and the parameter
  double lambda = 1e16;

  StiffBesideWeak() {
    const Eigen::Index n = r.A.rows(), size = r.A.cols();
    Eigen::MatrixXd straight(n, 2);
    straight << Eigen::VectorXd::Ones(n), Eigen::VectorXd::LinSpaced(n, -1.0, 1.0);
    Eigen::VectorXd beside = 2.0 * straight.col(0) - straight.col(1);
    for (Eigen::Index i = 0; i < n; ++i) beside[i] += 1e-3 * std::cos(0.7 * static_cast<double>(i));
    constexpr double sure = 1e3;
    X = Eigen::MatrixXd(n, size + 1);
    X << sure * r.A, beside;
    line = Eigen::MatrixXd(n, 3);
    line << sure * straight, beside;
  }
  [[nodiscard]] double expected() const { return inverse(line.transpose() * line)(2, 2); }
};

TEST(InvertWith, AStiffCurveIsALineInItsPlace) {
  const StiffBesideWeak s;
  Eigen::MatrixXd covariance;
  ASSERT_TRUE(invert_with(s.X.transpose() * s.X, penalty_eigenbasis(s.X.cols(), {penalty_of(s.r, s.lambda, false)}), covariance));
  EXPECT_NEAR(covariance.bottomRightCorner(1, 1)(0, 0), s.expected(), 1e-3 * s.expected());
}

TEST(UncertainRoughness, OfAStiffCurveIsThatOfALineInItsPlace) {
  const StiffBesideWeak s;
  NormalEquations problem;
  problem.N = s.X.transpose() * s.X;
  problem.theta = Eigen::VectorXd::Constant(s.X.cols(), 7.0);  // a line at 7
  problem.g = Eigen::VectorXd::Zero(s.X.cols());
  problem.prior = {Eigen::VectorXd::Constant(s.X.cols(), 1e-12), problem.theta};
  const Eigen::MatrixXd covariance = with_uncertain_roughness(problem, {penalty_of(s.r, s.lambda, true)}, 1.0);
  ASSERT_GT(covariance.size(), 0);
  const double found = covariance.bottomRightCorner(1, 1)(0, 0);
  EXPECT_GT(found, 0.99 * s.expected());
  EXPECT_LT(found, 2.0 * s.expected()) << "some bends cannot be excluded, but nothing is lost in rounding";
}

/// The same Gaussian, written down at its maximum and beside it, where a bound has left the estimate.
TEST(UncertainRoughness, HowFarABoundHoldsTheEstimateFromTheMaximumIsNoUncertainty) {
  const CurveMeasurements r = measurements();
  Eigen::VectorXd y(r.A.rows());
  for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = 4.0 * std::sin(0.05 * static_cast<double>(i)) + (i % 2 == 0 ? 1.0 : -1.0);
  const NormalEquations problem = problem_of(r, y);
  std::vector<Penalty> penalties{penalty_of(r, 1.0, true)};
  const PenalisedFit smoothed = estimate_smoothing(problem, penalties, 1.0);
  const NormalEquations at = at_maximum(problem, smoothed);
  NormalEquations beside = at;
  const Eigen::VectorXd away = Eigen::VectorXd::Constant(at.theta.size(), 0.5);
  beside.theta += away;
  beside.g += at.N * away;
  const Eigen::MatrixXd expected = with_uncertain_roughness(at, penalties, 1.0);
  EXPECT_LT((with_uncertain_roughness(beside, penalties, 1.0) - expected).norm(), 1e-6 * expected.norm());
}

}  // namespace
}  // namespace misfit
