#include "misfit/inference/coloured.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

/// A regression y = J θ + v with `channels` interleaved channels, solved with prior precision P about 0.
struct Regression {
  ResidualRows rows;
  Eigen::MatrixXd plain;
  Eigen::VectorXd theta;
};

Regression solved(const RowMatrix& J, const Eigen::VectorXd& y, const Eigen::MatrixXd& P, const std::vector<bool>& counts = {}) {
  Regression out;
  out.rows.J = J;
  out.rows.r = y;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (!counts[i]) out.rows.J.row(static_cast<Eigen::Index>(i)).setZero();
  }
  const RowMatrix& used = out.rows.J;
  const Eigen::VectorXd known = counts.empty() ? y : y.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; }).eval();
  out.plain = inverse(used.transpose() * used + P);
  out.theta = out.plain * (used.transpose() * known);
  out.rows.r = used * out.theta - known;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (!counts[i]) out.rows.r[static_cast<Eigen::Index>(i)] = std::nan("");
  }
  for (Eigen::Index c = 0; c < J.cols(); ++c) out.rows.place.push_back(c);
  return out;
}

Eigen::VectorXd first_order(std::mt19937_64& random, Eigen::Index n, double phi) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd v(n);
  v[0] = normal(random);
  for (Eigen::Index i = 1; i < n; ++i) v[i] = phi * v[i - 1] + std::sqrt(1.0 - phi * phi) * normal(random);
  return v;
}

/// A constant, a slope and two slow waves.
RowMatrix waves(Eigen::Index n) {
  RowMatrix J(n, 4);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(n);
    J.row(i) << 1.0, t - 0.5, std::sin(60.0 * t), std::cos(60.0 * t);
  }
  return J;
}

Eigen::MatrixXd exact(const RowMatrix& J, const Eigen::MatrixXd& plain, double phi, const Eigen::MatrixXd& P) {
  // R J by two recursions: forwards and backwards.
  RowMatrix ahead = J, behind = J;
  for (Eigen::Index i = 1; i < J.rows(); ++i) behind.row(i) += phi * behind.row(i - 1);
  for (Eigen::Index i = J.rows() - 2; i >= 0; --i) ahead.row(i) += phi * ahead.row(i + 1);
  return plain * (J.transpose() * (ahead + behind - J) + P) * plain;
}

/// Mean over seeds of sigma² of each unknown against what it truly is.
Eigen::VectorXd mean_ratio(double phi, const Eigen::MatrixXd& P, double missing = 0.0) {
  constexpr Eigen::Index n = 1200;
  constexpr int seeds = 40;
  const RowMatrix J = waves(n);
  Eigen::VectorXd ratio = Eigen::VectorXd::Zero(J.cols());
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(seed);
    Eigen::VectorXd y = first_order(random, n, phi);
    std::vector<bool> counts;
    for (Eigen::Index i = 0; i < n && missing > 0.0; ++i) {
      counts.push_back(std::uniform_real_distribution<double>(0.0, 1.0)(random) >= missing);
      if (!counts.back()) y[i] = std::nan("");
    }
    const Regression regression = solved(J, y, P, counts);
    const Eigen::MatrixXd truth = exact(regression.rows.J, regression.plain, phi, P);
    const ColouredCovariance found = coloured_covariance({regression.rows}, regression.plain, 1);
    ratio += found.covariance.diagonal().cwiseQuotient(truth.diagonal()) / seeds;
  }
  return ratio;
}

TEST(ColouredCovariance, WhiteResidualsKeepNearlyThePlainOne) {
  constexpr Eigen::Index n = 1200;
  const RowMatrix J = waves(n);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random(seed);
    const Regression regression = solved(J, first_order(random, n, 0.0), Eigen::MatrixXd::Zero(4, 4));
    const ColouredCovariance found = coloured_covariance({regression.rows}, regression.plain, 1);
    for (Eigen::Index c = 0; c < 4; ++c) EXPECT_NEAR(found.covariance(c, c) / regression.plain(c, c), 1.0, 0.6) << "seed " << seed;
  }
  const Eigen::VectorXd mean = mean_ratio(0.0, Eigen::MatrixXd::Zero(4, 4));
  for (Eigen::Index c = 0; c < 4; ++c) EXPECT_NEAR(mean[c], 1.0, 0.1);
}

TEST(ColouredCovariance, IsTheAnalyticOneOfARegressionWithFirstOrderNoise) {
  for (const double phi : {0.5, 0.8, -0.5}) {
    const Eigen::VectorXd mean = mean_ratio(phi, Eigen::MatrixXd::Zero(4, 4));
    for (Eigen::Index c = 0; c < 4; ++c) EXPECT_NEAR(mean[c], 1.0, 0.15) << "phi " << phi << ", unknown " << c;
    std::printf("phi %.1f: variance over the true one %.2f %.2f %.2f %.2f\n", phi, mean[0], mean[1], mean[2], mean[3]);
  }
}

/// The variance of a residual variance: Σ ρ² = (1 + φ²)/(1 − φ²) of first-order noise, and so it scatters over seeds.
TEST(ColouredCovariance, SquaredCorrelationsAreThoseByWhichAVarianceScatters) {
  constexpr Eigen::Index n = 1200;
  constexpr double phi = 0.7;
  constexpr int seeds = 60;
  const RowMatrix J = waves(n);
  double reported = 0.0, mean = 0.0, squares = 0.0;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(seed);
    const Regression regression = solved(J, first_order(random, n, phi), Eigen::MatrixXd::Zero(4, 4));
    reported += coloured_covariance({regression.rows}, regression.plain, 1).squared_correlations[0] / seeds;
    const double variance = regression.rows.r.squaredNorm() / (n - 4);
    mean += variance / seeds;
    squares += variance * variance / seeds;
  }
  EXPECT_NEAR(reported, (1.0 + phi * phi) / (1.0 - phi * phi), 0.5);
  EXPECT_NEAR((squares - mean * mean) / (2.0 / n), reported, 1.2) << "a variance of 60 draws is known to 18 %";
}

TEST(ColouredCovariance, APriorsShareIsKnownExactly) {
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(4, 4);
  P.diagonal() << 1200.0, 400.0, 0.0, 4000.0;
  const Eigen::VectorXd mean = mean_ratio(0.6, P);
  for (Eigen::Index c = 0; c < 4; ++c) EXPECT_NEAR(mean[c], 1.0, 0.15) << c;
}

TEST(ColouredCovariance, MissingSamplesKeepTheirLags) {
  const Eigen::VectorXd mean = mean_ratio(0.8, Eigen::MatrixXd::Zero(4, 4), 0.4);
  for (Eigen::Index c = 0; c < 4; ++c) EXPECT_NEAR(mean[c], 1.0, 0.15) << c;
}

/// Two channels whose noise is one series, the second a sample later: what they show together is worth little more than one.
TEST(ColouredCovariance, ChannelsThatShareTheirNoiseAreNotCountedTwice) {
  constexpr Eigen::Index n = 1500;
  RowMatrix J(2 * n, 1);
  J.setOnes();
  double mean = 0.0;
  constexpr int seeds = 20;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(seed);
    const Eigen::VectorXd v = first_order(random, n + 1, 0.0);
    Eigen::VectorXd y(2 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      y[2 * i] = v[i + 1];
      y[2 * i + 1] = v[i];
    }
    const Regression regression = solved(J, y, Eigen::MatrixXd::Zero(1, 1));
    mean += coloured_covariance({regression.rows}, regression.plain, 2).covariance(0, 0) / regression.plain(0, 0) / seeds;
  }
  EXPECT_NEAR(mean, 2.0, 0.15);
}

/// Each experiment has an unknown of its own beside the common one.
TEST(ColouredCovariance, SeveralExperimentsShareTheirCorrelation) {
  constexpr Eigen::Index n = 700;
  const double phi = 0.7, truth = (1.0 + phi) / (1.0 - phi);
  double own = 0.0, common = 0.0;
  constexpr int seeds = 20;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(seed);
    std::vector<ResidualRows> experiments;
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3, 3);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(3);
    std::vector<Eigen::VectorXd> y;
    for (Eigen::Index e = 0; e < 2; ++e) {
      ResidualRows rows;
      rows.J.resize(n, 2);
      for (Eigen::Index i = 0; i < n; ++i) rows.J.row(i) << std::cos(0.01 * static_cast<double>(i)), 1.0;
      rows.place = {0, 1 + e};
      y.push_back(first_order(random, n, phi));
      H(rows.place, rows.place) += rows.J.transpose() * rows.J;
      b(rows.place) += rows.J.transpose() * y.back();
      experiments.push_back(std::move(rows));
    }
    const Eigen::MatrixXd plain = inverse(H);
    const Eigen::VectorXd theta = plain * b;
    for (std::size_t e = 0; e < 2; ++e) experiments[e].r = experiments[e].J * theta(experiments[e].place) - y[e];
    const Eigen::MatrixXd found = coloured_covariance(experiments, plain, 1).covariance;
    common += found(0, 0) / plain(0, 0) / truth / seeds;
    own += found(2, 2) / plain(2, 2) / truth / seeds;
  }
  EXPECT_NEAR(common, 1.0, 0.15);
  EXPECT_NEAR(own, 1.0, 0.15);
}

/// Two channels of one constant and slope, 5 and 95 % of the rows, never together; the noise of the slow one has memory from one of its
/// own samples to the next.
TEST(ColouredCovariance, OfChannelsWithOwnClocksCountsLagsInTheirOwnSamples) {
  constexpr Eigen::Index n = 16000, every = 20, slow = n / every;
  constexpr int seeds = 40;
  for (const double phi : {0.0, 0.6}) {
    RowMatrix J = RowMatrix::Zero(2 * n, 2), own(slow, 2);
    std::vector<bool> counts(2 * n, false);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Index row = 2 * i + (i % every == 7 ? 1 : 0);
      counts[static_cast<std::size_t>(row)] = true;
      // The slow channel is five times as exact: what is known comes from both.
      const double t = static_cast<double>(i) / n - 0.5, weight = row % 2 == 0 ? 1.0 : 5.0;
      J.row(row) << weight, weight * t;
      if (row % 2 == 1) own.row(i / every) = J.row(row);
    }
    const Eigen::MatrixXd plain = inverse(J.transpose() * J), slow_plain = inverse(own.transpose() * own);
    const Eigen::MatrixXd of_slow = inverse(slow_plain) * exact(own, slow_plain, phi, Eigen::MatrixXd::Zero(2, 2)) * inverse(slow_plain);
    const Eigen::MatrixXd truth = plain * (J.transpose() * J - own.transpose() * own + of_slow) * plain;
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(2);
    for (unsigned seed = 1; seed <= seeds; ++seed) {
      std::mt19937_64 random(seed);
      std::normal_distribution<double> normal;
      const Eigen::VectorXd coloured = first_order(random, slow, phi);
      Eigen::VectorXd y = Eigen::VectorXd::Constant(2 * n, std::nan(""));
      for (Eigen::Index i = 0; i < n; ++i) y[2 * i + (i % every == 7 ? 1 : 0)] = i % every == 7 ? coloured[i / every] : normal(random);
      const Regression regression = solved(J, y, Eigen::MatrixXd::Zero(2, 2), counts);
      const ColouredCovariance found = coloured_covariance({regression.rows}, regression.plain, 2);
      mean += found.covariance.diagonal().cwiseQuotient(truth.diagonal()) / seeds;
    }
    for (Eigen::Index c = 0; c < 2; ++c) EXPECT_NEAR(mean[c], 1.0, 0.12) << "correlation " << phi;
  }
}

TEST(ColouredCovariance, IsPositiveForHardlyAnySamples) {
  for (const Eigen::Index n : {5, 9, 30}) {
    std::mt19937_64 random(3);
    const Regression regression = solved(waves(n), first_order(random, n, 0.9), Eigen::MatrixXd::Identity(4, 4));
    const Eigen::MatrixXd found = coloured_covariance({regression.rows}, regression.plain, 1).covariance;
    ASSERT_TRUE(found.allFinite()) << n;
    EXPECT_GE(symmetric_eigen(found).values[0], -1e-12) << n;
  }
}

/// Samples held out are no measurements.
TEST(ColouredCovariance, ItsDegreesOfFreedomAreOfTheResidualsThatCount) {
  constexpr Eigen::Index n = 300;
  std::mt19937_64 random(2);
  const Regression whole = solved(waves(n), first_order(random, n, 0.6), Eigen::MatrixXd::Zero(4, 4));
  ResidualRows with_more = whole.rows;
  with_more.J.conservativeResize(10 * n, Eigen::NoChange);
  with_more.J.bottomRows(9 * n).setZero();
  with_more.r.conservativeResize(10 * n);
  with_more.r.tail(9 * n).setConstant(std::nan(""));
  const double degrees = coloured_covariance({whole.rows}, whole.plain, 1).degrees;
  EXPECT_NEAR(coloured_covariance({with_more}, whole.plain, 1).degrees, degrees, 1e-9 * degrees);
}

}  // namespace
}  // namespace misfit
