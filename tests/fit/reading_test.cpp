#include "misfit/fit/filter/reading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/fit/cart_filter.h"

using namespace misfit;

namespace {

/// Probability and moments of w ~ N(0, S) within q/2 of `departure`, by the midpoint rule.
struct Truncated {
  double log_p = 0.0, mean = 0.0, variance = 0.0;
  Truncated(double departure, double S, double q) {
    constexpr int cells = 200000;
    const double h = q / cells, nearest = std::max(std::abs(departure) - 0.5 * q, 0.0);
    double sum = 0.0, first = 0.0, second = 0.0;
    for (int i = 0; i < cells; ++i) {
      const double w = departure - 0.5 * q + (i + 0.5) * h;
      const double weight = std::exp(-0.5 * (w * w - nearest * nearest) / S);
      sum += weight;
      first += weight * w;
      second += weight * w * w;
    }
    mean = first / sum;
    variance = second / sum - mean * mean;
    log_p = std::log(sum * h / std::sqrt(2.0 * std::numbers::pi * S)) - 0.5 * nearest * nearest / S;
  }
};

}  // namespace

TEST(ReadInSteps, HasTheMomentsOfATruncatedNormal) {
  constexpr double q = 0.8;
  for (const double departure : {0.0, 0.3, -0.3, 0.5, -1.7, 3.0}) {
    for (const double sigma : {0.15, 0.5, 3.0}) {
      const double S = sigma * sigma;
      const Truncated exact(departure, S, q);
      const Reading r = read_in_steps(departure, S, q);
      // What a linear update of w with its own variance makes of it: mean S/r.S r.e, variance S - S²/r.S.
      EXPECT_NEAR(S / r.S * r.e, exact.mean, 1e-6 * sigma) << departure << ' ' << sigma;
      EXPECT_NEAR(S - S * S / r.S, exact.variance, 1e-6 * S) << departure << ' ' << sigma;
      EXPECT_NEAR(r.minus_log, std::log(q) - exact.log_p, 1e-6 * (1.0 + std::abs(exact.log_p))) << departure << ' ' << sigma;
    }
  }
}

TEST(ReadInSteps, ItsInnovationAndVarianceAreTheDerivativesOfItsDensity) {
  constexpr double q = 0.8, h = 1e-5;
  for (const double departure : {0.1, -0.45, 1.2}) {
    for (const double S : {0.01, 0.3, 4.0}) {
      const auto minus_log = [&](double by, double more) { return read_in_steps(departure + by, S + more, q).minus_log; };
      const Reading r = read_in_steps(departure, S, q);
      EXPECT_NEAR((minus_log(h, 0.0) - minus_log(-h, 0.0)) / (2.0 * h), r.e / r.S, 1e-5 * (1.0 + std::abs(r.e / r.S)));
      const double h_S = h * S;
      EXPECT_NEAR((minus_log(0.0, h_S) - minus_log(0.0, -h_S)) / (2.0 * h_S), 0.5 * (1.0 - r.e * r.e / r.S) / r.S,
                  1e-4 * (1.0 + std::abs(1.0 / r.S)));
    }
  }
}

TEST(ReadInSteps, InFineStepsIsAsItIsWithTheVarianceOfRounding) {
  for (const double q : {1e-5, 0.02}) {
    const Reading fine = read_in_steps(1.3, 1.0, q), as_it_is = read_as_it_is(1.3, 1.0 + q * q / 12.0);
    EXPECT_NEAR(fine.e, as_it_is.e, 1e-5) << q;
    EXPECT_NEAR(fine.S, as_it_is.S, 1e-5) << q;
    EXPECT_NEAR(fine.minus_log, as_it_is.minus_log, 1e-5) << q;
  }
}

TEST(ReadInSteps, OfAPredictionThatIsFarOffOrSharpIsFinite) {
  const Reading far = read_in_steps(-100.0, 1e-4, 0.8);  // 9960 sigmas outside
  EXPECT_NEAR(far.e, -99.6, 0.01);
  EXPECT_NEAR(far.S, 1e-4, 1e-6);
  EXPECT_TRUE(std::isfinite(far.minus_log));
  const Reading sharp = read_in_steps(0.01, 1e-8, 0.8);  // of which nothing is learnt
  EXPECT_GT(sharp.S, 1e3);
  EXPECT_LT(std::abs(sharp.e) / sharp.S, 1e-9);
  EXPECT_NEAR(sharp.minus_log, std::log(0.8), 1e-12);
}

namespace {

using testing_cart::Cart;

/// Its positions in steps of 0.1 m, and read so.
void round_positions(Cart& cart) {
  for (double& y : cart.signals.measured[0].values) y = 0.1 * std::round(y / 0.1);
  cart.data.steps = {0.1, 0.0};
}

}  // namespace

TEST(RunInSteps, TheLinearRunAtTheSameNoiseRepeatsIt) {
  Cart cart(200);
  round_positions(cart);
  const FilterTrace trace = cart.run();
  const Innovations innovations = run_linear(cart.model, cart.data, trace, cart.noise);
  EXPECT_NEAR(-minus_loglik(cart.data, innovations), trace.loglik, 1e-8 * std::abs(trace.loglik));
  for (std::size_t i = 0; i < trace.e.size(); ++i) EXPECT_NEAR(innovations.departure(i), trace.departure(i), 1e-9) << i;
}

TEST(RunInSteps, TheJacobianIsTheSlopeOfTheLikelihoodWithTheGainsFixed) {
  Cart cart(60);
  round_positions(cart);
  FilterJacobian jacobian;
  const FilterTrace trace = cart.run(&jacobian);
  ASSERT_EQ(jacobian.index.size(), 120U);
  for (Eigen::Index r = 0; r < jacobian.r.size(); ++r) {
    const std::size_t at = jacobian.index[static_cast<std::size_t>(r)];
    EXPECT_DOUBLE_EQ(jacobian.r[r], -trace.e[at] / std::sqrt(trace.S[at]));
  }
  // Positions that are read to 0.1 m say less of the stiffness than as they were measured, and not nothing.
  Cart as_measured(60);
  FilterJacobian fine;
  static_cast<void>(as_measured.run(&fine));
  EXPECT_LT(jacobian.J.squaredNorm(), fine.J.squaredNorm());
  EXPECT_GT(jacobian.J.squaredNorm(), 0.2 * fine.J.squaredNorm());
}
