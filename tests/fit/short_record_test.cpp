// How often the 95 % intervals of short records hold the truth.
#include "misfit/inference/short_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "misfit/fit/trajectory_start.h"
#include "misfit/inference/coloured.h"
#include "tests/fit/decay.h"

namespace misfit {
namespace {

using namespace testing_decay;

struct Coverage {
  int given = 0, inside = 0, withheld = 0, failed = 0, alarms = 0;
  double size = 0.0;  ///< mean of (value − truth)²/sigma² of those given
};

Coverage coverage(const Model& model, bool filter, std::size_t samples, unsigned seeds) {
  Coverage out;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const std::vector<Signals> experiments{decay(samples, seed)};
    const TrajectoryStart start = trajectory_start(model, experiments);
    OutputErrorStart options;
    options.from_regression = start.regressed;
    FilterOptions one;
    one.threads = 1;
    const Fit fit = filter ? filter_error(start.from, experiments, one).fit : output_error(start.from, experiments, options).fit;
    if (fit.status != FitStatus::converged) {
      ++out.failed;
      continue;
    }
    for (const auto& w : fit.warnings) out.alarms += w.find("not white") != std::string::npos ? 1 : 0;
    const Estimate& a = fit.parameters.at("a");
    if (!(a.sigma > 0.0)) {
      ++out.withheld;
      EXPECT_THAT(fit.warnings, testing::Contains(testing::HasSubstr("no sigma is given"))) << samples;
      continue;
    }
    constexpr double normal = 1.96;
    const auto [low, high] = a.interval.value_or(std::pair{a.value - normal * a.sigma, a.value + normal * a.sigma});
    ++out.given;
    out.inside += low <= truth && truth <= high ? 1 : 0;
    out.size += std::pow((a.value - truth) / a.sigma, 2);
  }
  std::printf("%s, %3zu samples: %3d intervals, %5.1f %% hold; withheld %d, not converged %d, mean z^2 %.2f, not white %d\n",
              filter ? "filter_error" : "output_error", samples, out.given, 100.0 * out.inside / std::max(out.given, 1), out.withheld,
              out.failed, out.size / std::max(out.given, 1), out.alarms);
  return out;
}

TEST(ShortRecords, IntervalsOfOutputErrorHoldOrAreNotGiven) {
  const auto known = registry_with(decay_text);
  const Model model = assemble(request_of("text"), *known);
  constexpr unsigned seeds = 500;
  for (const std::size_t samples : {2U, 3U, 4U, 5U, 6U, 8U, 10U, 20U, 50U, 100U}) {
    const Coverage c = coverage(model, false, samples, seeds);
    EXPECT_EQ(c.failed, 0) << samples;
    EXPECT_LE(c.alarms, 3) << samples;
    if (c.given == 0) continue;
    EXPECT_GE(c.inside, 0.92 * c.given) << samples;
    EXPECT_LE(c.inside, 0.975 * c.given) << samples;
  }
}

TEST(ShortRecords, IntervalsOfFilterErrorHoldOrAreNotGiven) {
  const auto known = registry_with(decay_text);
  const Model model = assemble(request_of("text"), *known);
  constexpr unsigned seeds = 500;
  for (const std::size_t samples : {4U, 5U, 6U, 8U, 10U, 12U, 15U, 20U, 50U}) {
    const Coverage c = coverage(model, true, samples, seeds);
    EXPECT_TRUE(c.given == 0 || c.withheld == 0) << samples;
    if (c.given == 0) continue;
    EXPECT_GE(c.inside, 0.92 * c.given) << samples;
    EXPECT_LE(c.inside, 0.975 * c.given) << samples;
  }
}

Fit with_one_parameter() {
  Fit fit;
  fit.parameters["a"] = {2.0, 0.1, "1/s"};
  fit.plain_sigmas["a"] = 0.09;
  fit.noise["y"] = {0.01, 0.001, "V"};
  fit.covariance = Eigen::MatrixXd::Constant(1, 1, 0.01);
  return fit;
}

TEST(ShortRecords, IntervalsAreStudentsAndTheSigmaStaysTheStandardError) {
  Fit fit = with_one_parameter();
  add_student_intervals(10.0, fit);
  const Estimate& a = fit.parameters.at("a");
  EXPECT_EQ(a.sigma, 0.1);
  ASSERT_TRUE(a.interval.has_value());
  EXPECT_NEAR(a.interval->first, 2.0 - 0.2228, 1e-4);
  EXPECT_NEAR(a.interval->second, 2.0 + 0.2228, 1e-4);
}

TEST(ShortRecords, WithheldSigmasAreNotGivenAnywhere) {
  Fit fit = with_one_parameter();
  add_student_intervals(10.0, fit);
  withhold_sigmas("too few", fit);
  EXPECT_EQ(fit.parameters.at("a").value, 2.0);
  EXPECT_EQ(fit.parameters.at("a").sigma, 0.0);
  EXPECT_FALSE(fit.parameters.at("a").interval.has_value());
  EXPECT_EQ(fit.plain_sigmas.at("a"), 0.0);
  EXPECT_EQ(fit.noise.at("y").sigma, 0.0);
  EXPECT_TRUE(std::isnan(fit.covariance(0, 0)));
  EXPECT_EQ(fit.warnings, std::vector<std::string>{"too few"});
}

/// A constant fitted to 60 values of first-order noise.
ColouredCovariance of_a_constant(double memory, unsigned seed) {
  constexpr Eigen::Index n = 60;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  ResidualRows rows{RowMatrix::Ones(n, 1), Eigen::VectorXd(n), {0}};
  double last = normal(random) / std::sqrt(1.0 - memory * memory);
  for (double& r : rows.r) r = last = memory * last + normal(random);
  rows.r.array() -= rows.r.mean();
  rows.r /= std::sqrt(rows.r.squaredNorm() / (n - 1.0));
  const Eigen::MatrixXd plain = Eigen::MatrixXd::Constant(1, 1, 1.0 / static_cast<double>(n));
  return residual_covariance({rows}, plain, 1, n - 1.0);
}

TEST(ShortRecords, MemoryWidensWhereItIsSeenAndNeverNarrows) {
  int plain = 0, wider = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    plain += of_a_constant(0.0, seed).covariance(0, 0) * 60.0 == 1.0 ? 1 : 0;
    wider += of_a_constant(0.8, seed).covariance(0, 0) * 60.0 > 2.0 ? 1 : 0;
    EXPECT_GE(of_a_constant(-0.8, seed).covariance(0, 0) * 60.0, 1.0 - 1e-12) << seed;
  }
  EXPECT_GE(plain, 88) << "95 of 100 pass the test of whiteness";
  EXPECT_GE(wider, 90) << "the true variance is nine times as large";
}

TEST(ShortRecords, IntervalsAreSaidToBeStudentsWhereTheyAreGiven) {
  const ColouredCovariance white = white_covariance(Eigen::MatrixXd::Identity(1, 1), 1);
  EXPECT_THAT(in_words(white), testing::Not(testing::HasSubstr("Student")));
  Fit fit = with_one_parameter();
  fit.facts["covariance"] = in_words(white);
  add_student_intervals(0.5, fit);
  EXPECT_EQ(fit.facts.at("covariance"), in_words(white)) << "none are given";
  add_student_intervals(10.0, fit);
  EXPECT_THAT(fit.facts.at("covariance"), testing::EndsWith("white residuals; 95 % intervals are by Student's t"));
}

}  // namespace
}  // namespace misfit
