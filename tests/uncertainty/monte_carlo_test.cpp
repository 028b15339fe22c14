#include "misfit/uncertainty/monte_carlo.h"

#include <gtest/gtest.h>

#include <cmath>

#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

/// The covariance of two correlated parameters.
Eigen::MatrixXd covariance(double sigma_a, double sigma_b, double correlation) {
  Eigen::MatrixXd c(2, 2);
  c << sigma_a * sigma_a, correlation * sigma_a * sigma_b, correlation * sigma_a * sigma_b, sigma_b * sigma_b;
  return c;
}

Perturbations two_alone() { return {{{"a", "m", 0.5, false}, {"b", "kg", 2.0, false}}, {}}; }

class MonteCarlo : public testing::Test {
 protected:
  MonteCarloResult run(const Perturbations& perturbations, const Chain& chain, std::size_t runs = 4000, int threads = 2,
                       const std::string& folder = "jobs") const {
    MonteCarloOptions options;
    options.jobs = {folder_.path() / folder, "digest", runs, threads};
    options.shared = 1;
    return *monte_carlo(Sampler(perturbations, 7), chain, options);
  }
  TemporaryFolder folder_;
};

/// y = 10 + 6 a + 2 b: variance 9 + 16, shares 0.36 and 0.64, nothing together.
TEST_F(MonteCarlo, ALinearChainGivesItsKnownMeanSigmaAndShares) {
  const auto result = run(two_alone(), [](const auto& e) { return ChainResult{{10.0 + 6.0 * e[0] + 2.0 * e[1]}, ""}; });
  EXPECT_EQ(result.runs, 4000U);
  EXPECT_EQ(result.failed, 0U);
  EXPECT_EQ(result.numbers[0].count, 4000U);
  EXPECT_NEAR(result.numbers[0].mean, 10.0, 4.0 * 5.0 / std::sqrt(4000.0));
  EXPECT_NEAR(result.numbers[0].sigma, 5.0, 4.0 * 5.0 / std::sqrt(8000.0));
  const VarianceShares& shares = result.shares[0];
  ASSERT_EQ(shares.share.size(), 2U);
  EXPECT_NEAR(shares.share[0], 0.36, 1e-9);
  EXPECT_NEAR(shares.share[1], 0.64, 1e-9);
  EXPECT_NEAR(shares.rest, 0.0, 1e-9);
  EXPECT_NEAR(shares.effect[0], 3.0, 1e-9);
  EXPECT_NEAR(shares.effect[1], 4.0, 1e-9);
}

TEST_F(MonteCarlo, AUniformErrorHasItsSigmaAndStaysInside) {
  const Perturbations uniform{{{"a", "m", 2.0, true}}, {}};
  double furthest = 0.0;
  const auto result = run(
      uniform,
      [&](const auto& e) {
        furthest = std::max(furthest, std::abs(e[0]));
        return ChainResult{{e[0] * e[0]}, ""};
      },
      4000, 1);
  EXPECT_LT(furthest, 2.0 * std::sqrt(3.0));
  EXPECT_GT(furthest, 1.99 * std::sqrt(3.0));
  EXPECT_NEAR(result.numbers[0].mean, 4.0, 0.25);
  // A square of one parameter is its own doing: P2 of Legendre holds it exactly.
  EXPECT_NEAR(result.shares[0].share[0], 1.0, 1e-9);
}

/// y = a + c, both of sigma 1 and correlation 0.5 with a lone b: variance 3 + 1.
TEST_F(MonteCarlo, CorrelatedParametersShareAsOne) {
  const Perturbations p{{{"b", "-", 1.0, false}}, {{"calibration", {"a", "c"}, {"-", "-"}, covariance(1.0, 1.0, 0.5)}}};
  const auto result = run(p, [](const auto& e) { return ChainResult{{e[0] + e[1] + e[2]}, ""}; });
  EXPECT_NEAR(result.numbers[0].sigma, 2.0, 4.0 * 2.0 / std::sqrt(8000.0));
  EXPECT_NEAR(result.shares[0].share[0], 0.25, 1e-9);
  EXPECT_NEAR(result.shares[0].share[1], 0.75, 1e-9);
  EXPECT_TRUE(std::isnan(result.shares[0].effect[1]));
}

TEST_F(MonteCarlo, TheirSampledCovarianceIsTheOneGiven) {
  const Eigen::MatrixXd wanted = covariance(0.5, 3.0, -0.8);
  const Sampler sampler({{}, {{"calibration", {"a", "b"}, {"-", "-"}, wanted}}}, 3);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(2, 2);
  constexpr int n = 20000;
  for (std::size_t k = 0; k < n; ++k) {
    const Draw draw = sampler.draw(k);
    const Eigen::Vector2d e(draw.errors[0], draw.errors[1]);
    sum += e * e.transpose() / n;
  }
  EXPECT_NEAR(sum(0, 0), wanted(0, 0), 0.04 * wanted(0, 0));
  EXPECT_NEAR(sum(1, 1), wanted(1, 1), 0.04 * wanted(1, 1));
  EXPECT_NEAR(sum(0, 1), wanted(0, 1), 0.06);
}

TEST(Sampler, ACovarianceThatIsNoneIsRefused) {
  expect_parts(message_of<InputError>([] {
                 Sampler({{}, {{"calibration", {"a", "b"}, {"-", "-"}, covariance(1.0, 1.0, 1.5), "out/camera.json, covariance"}}}, 1);
               }),
               {"out/camera.json, covariance: ", "calibration", "not positive semi-definite"});
}

TEST(Sampler, AFullyCorrelatedPairMovesAsOne) {
  const Sampler sampler({{}, {{"calibration", {"a", "b"}, {"-", "-"}, covariance(1.0, 2.0, 1.0)}}}, 1);
  for (std::size_t k = 0; k < 20; ++k) {
    const Draw draw = sampler.draw(k);
    EXPECT_NEAR(draw.errors[1], 2.0 * draw.errors[0], 1e-7);
  }
}

TEST(Sampler, AnotherParameterDoesNotChangeTheOthersErrors) {
  Perturbations more = two_alone();
  more.single.insert(more.single.begin(), {"new", "-", 1.0, false});
  const Draw few = Sampler(two_alone(), 7).draw(3), all = Sampler(more, 7).draw(3);
  EXPECT_EQ(few.errors[0], all.errors[1]);
  EXPECT_EQ(few.errors[1], all.errors[2]);
  EXPECT_NE(few.errors[0], Sampler(two_alone(), 8).draw(3).errors[0]);
}

/// y = a b has no first-order share at all.
TEST_F(MonteCarlo, WhatActsTogetherIsTheRest) {
  const auto result = run(two_alone(), [](const auto& e) { return ChainResult{{e[0] * e[1]}, ""}; });
  EXPECT_NEAR(result.shares[0].rest, 1.0, 0.02);
  EXPECT_LT(result.shares[0].share[0], 0.01 + 3.0 * result.shares[0].sigma[0]);
}

TEST_F(MonteCarlo, ANumberThatDoesNotVaryHasNoShares) {
  const auto result = run(two_alone(), [](const auto&) { return ChainResult{{0.1}, ""}; });
  EXPECT_NEAR(result.numbers[0].sigma, 0.0, 1e-12);
  EXPECT_TRUE(result.shares[0].share.empty());
}

TEST_F(MonteCarlo, TooFewRunsForSharesGiveNone) {
  const auto chain = [](const auto& e) { return ChainResult{{e[0]}, ""}; };
  const auto one = run(two_alone(), chain, 1);
  EXPECT_TRUE(one.shares[0].share.empty());
  EXPECT_TRUE(std::isnan(one.numbers[0].sigma));
  EXPECT_EQ(one.numbers[0].count, 1U);
}

TEST_F(MonteCarlo, TheBitsDoNotDependOnThreadsNorOnBeingCutShort) {
  const auto chain = [](const auto& e) { return ChainResult{{std::sin(e[0]) + e[1], std::exp(e[1])}, ""}; };
  const auto one = run(two_alone(), chain, 500, 1, "one"), four = run(two_alone(), chain, 500, 4, "four");
  (void)run(two_alone(), chain, 123, 3, "part");
  const auto rest = run(two_alone(), chain, 500, 2, "part");
  for (const auto* other : {&four, &rest}) {
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(one.numbers[i].mean, other->numbers[i].mean);
      EXPECT_EQ(one.numbers[i].sigma, other->numbers[i].sigma);
    }
    EXPECT_EQ(one.shares[0].share, other->shares[0].share);
  }
}

TEST_F(MonteCarlo, FailedRunsAreCountedWithTheirReasons) {
  const auto result = run(two_alone(), [](const auto& e) {
    if (e[0] > 0.5) return ChainResult{{}, "too long"};
    return ChainResult{{e[0], e[1] > 0.0 ? e[1] : std::nan("")}, ""};
  });
  EXPECT_NEAR(static_cast<double>(result.failed), 0.1587 * 4000.0, 100.0);
  EXPECT_EQ(result.failures.at("too long"), result.failed);
  EXPECT_EQ(result.numbers[0].count, 4000U - result.failed);
  EXPECT_NEAR(static_cast<double>(result.numbers[1].count), 0.5 * static_cast<double>(result.numbers[0].count), 150.0);
}

TEST_F(MonteCarlo, ManyReasonsAreCountedTogether) {
  int k = 0;
  const auto result = run(
      two_alone(),
      [&](const auto& e) {
        return e[0] > 0.0 ? ChainResult{{1.0}, ""} : ChainResult{{}, "reason " + std::to_string(++k)};
      },
      200, 1);
  EXPECT_EQ(result.failures.size(), 21U);
  EXPECT_EQ(result.failures.at("other reasons"), result.failed - 20U);
}

TEST_F(MonteCarlo, NothingButFailuresIsAnErrorWithTheReason) {
  expect_parts(message_of<RunError>([&] {
                 (void)run(
                     two_alone(),
                     [](const auto&) {
                       return ChainResult{{}, "no sample is left"};
                     },
                     10);
               }),
               {"all 10 runs failed", "no sample is left"});
}

}  // namespace
}  // namespace misfit
