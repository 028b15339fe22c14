#include "misfit/math/least_squares.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <vector>

#include "misfit/core/watch.h"

namespace misfit {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

// y = a exp(b x) at x = 0, 0.1, …, with the values given.
LeastSquares::Evaluate exponential(const std::vector<double>& y) {
  return [y](const double* const* p, double* r, double** J) {
    const double a = p[0][0];
    const double b = p[0][1];
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double x = 0.1 * static_cast<double>(i);
      r[i] = a * std::exp(b * x) - y[i];
      if (J == nullptr || J[0] == nullptr) continue;
      J[0][2 * i] = std::exp(b * x);
      J[0][2 * i + 1] = a * x * std::exp(b * x);
    }
    return true;
  };
}

std::vector<double> exponential_data(double a, double b, int n) {
  std::vector<double> y;
  for (int i = 0; i < n; ++i) y.push_back(a * std::exp(b * 0.1 * i));
  return y;
}

// r = p − target, one residual.
LeastSquares::Evaluate pull_to(double target) {
  return [target](const double* const* p, double* r, double** J) {
    r[0] = p[0][0] - target;
    if (J != nullptr && J[0] != nullptr) J[0][0] = 1.0;
    return true;
  };
}

TEST(LeastSquares, ExactExponentialIsRecovered) {
  LeastSquares problem;
  const int block = problem.add_block({1.0, 0.0});
  problem.add_residuals({block}, 20, exponential(exponential_data(2.5, -1.3, 20)));
  const auto summary = problem.solve({});
  EXPECT_TRUE(summary.converged) << summary.message;
  EXPECT_TRUE(summary.usable);
  EXPECT_EQ(summary.message, "the slope of the sum of squares is zero");
  EXPECT_NEAR(problem.block(block)[0], 2.5, 1e-9);
  EXPECT_NEAR(problem.block(block)[1], -1.3, 1e-9);
  EXPECT_LT(summary.cost, 1e-16);
  EXPECT_EQ(summary.iterations, summary.linearisations - 1);
  EXPECT_GT(summary.linearisations, 2);
}

TEST(LeastSquares, LargeProblemUsesNormalEquationsAndAgreesWithSparse) {
  std::vector<double> solutions;
  for (const bool sparse : {false, true}) {
    LeastSquares problem;
    const int block = problem.add_block({1.0, 0.0});
    std::vector<double> y = exponential_data(2.0, 0.001, 12000);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += 0.1 * std::sin(static_cast<double>(i * i));
    problem.add_residuals({block}, 12000, exponential(y));
    LeastSquares::Options options;
    options.sparse = sparse;
    EXPECT_TRUE(problem.solve(options).converged);
    solutions.push_back(problem.block(block)[0]);
  }
  EXPECT_NEAR(solutions[0], 2.0, 0.01);
  EXPECT_NEAR(solutions[0], solutions[1], 1e-8);
}

TEST(LeastSquares, SeveralBlocksTiedByOneResidual) {
  LeastSquares problem;
  const int a = problem.add_block({0.0});
  const int b = problem.add_block({0.0});
  problem.add_residuals({a}, 1, pull_to(3.0));
  problem.add_residuals({a, b}, 1, [](const double* const* p, double* r, double** J) {
    r[0] = 10.0 * (p[1][0] - 2.0 * p[0][0]);
    if (J != nullptr && J[0] != nullptr) J[0][0] = -20.0;
    if (J != nullptr && J[1] != nullptr) J[1][0] = 10.0;
    return true;
  });
  EXPECT_TRUE(problem.solve({}).converged);
  EXPECT_NEAR(problem.block(a)[0], 3.0, 1e-8);
  EXPECT_NEAR(problem.block(b)[0], 6.0, 1e-8);
}

TEST(LeastSquares, SolutionBeyondABoundStopsAtTheBound) {
  LeastSquares problem;
  const int block = problem.add_block({1.0, 0.0}, {-inf, -1.0}, {inf, inf});
  problem.add_residuals({block}, 20, exponential(exponential_data(2.5, -1.3, 20)));
  const auto summary = problem.solve({});
  EXPECT_TRUE(summary.usable);
  EXPECT_DOUBLE_EQ(problem.block(block)[1], -1.0);
  EXPECT_GT(summary.cost, 1e-4);
}

TEST(LeastSquares, FixedBlockStays) {
  LeastSquares problem;
  const int a = problem.add_block({5.0});
  const int b = problem.add_block({1.0});
  problem.fix_block(a);
  problem.add_residuals({a, b}, 1, [](const double* const* p, double* r, double** J) {
    r[0] = p[0][0] + p[1][0] - 7.0;
    if (J == nullptr) return true;
    EXPECT_EQ(J[0], nullptr);
    if (J[1] != nullptr) J[1][0] = 1.0;
    return true;
  });
  EXPECT_TRUE(problem.solve({}).usable);
  EXPECT_EQ(problem.block(a)[0], 5.0);
  EXPECT_NEAR(problem.block(b)[0], 2.0, 1e-9);
}

TEST(LeastSquares, RobustLossIgnoresTheWildPointThatDragsThePlainFit) {
  const auto location = [](LeastSquares::Loss loss) {
    LeastSquares problem;
    const int block = problem.add_block({0.8});
    for (const double y : {1.0, 1.1, 0.9, 1.05, 0.95, 50.0}) problem.add_residuals({block}, 1, pull_to(y), {loss, 0.5});
    LeastSquares::Options options;
    options.function_tolerance = 1e-14;
    EXPECT_TRUE(problem.solve(options).usable);
    return problem.block(block)[0];
  };
  EXPECT_NEAR(location(LeastSquares::Loss::none), 55.0 / 6.0, 1e-6);
  EXPECT_NEAR(location(LeastSquares::Loss::huber), 1.1, 0.02);  // five pulls of (m − y), one of 0.5: 5 (m − 1) = 0.5
  EXPECT_NEAR(location(LeastSquares::Loss::cauchy), 1.0, 0.01);
  EXPECT_NEAR(location(LeastSquares::Loss::tukey), 1.0, 2e-3);
}

TEST(LeastSquares, FailureAtTheStartIsReportedInWords) {
  LeastSquares problem;
  const int block = problem.add_block({4.0});
  problem.add_residuals({block}, 1, [](const double* const*, double*, double**) { return false; });
  const auto summary = problem.solve({});
  EXPECT_FALSE(summary.converged);
  EXPECT_FALSE(summary.usable);
  EXPECT_EQ(summary.message, "the model cannot be evaluated at the values to start from");
  EXPECT_TRUE(std::isnan(summary.cost));
  EXPECT_EQ(problem.block(block)[0], 4.0);
}

TEST(LeastSquares, NonFiniteResidualAtTheStartIsAFailureNotACrash) {
  LeastSquares problem;
  const int block = problem.add_block({-1.0});
  problem.add_residuals({block}, 1, [](const double* const* p, double* r, double** J) {
    r[0] = std::sqrt(p[0][0]);
    if (J != nullptr && J[0] != nullptr) J[0][0] = 0.5 / r[0];
    return true;
  });
  testing::internal::CaptureStderr();
  const auto summary = problem.solve({});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_FALSE(summary.usable);
}

TEST(LeastSquares, FailureMidwayShortensTheStepAndTheFitGoesOn) {
  // log x + 3 = 0 from x = 1: the full Gauss–Newton step goes to −2, where the model cannot be evaluated.
  LeastSquares problem;
  const int block = problem.add_block({1.0});
  int failures = 0;
  problem.add_residuals({block}, 1, [&failures](const double* const* p, double* r, double** J) {
    if (p[0][0] <= 0.0) {
      ++failures;
      return false;
    }
    r[0] = std::log(p[0][0]) + 3.0;
    if (J != nullptr && J[0] != nullptr) J[0][0] = 1.0 / p[0][0];
    return true;
  });
  testing::internal::CaptureStderr();
  const auto summary = problem.solve({});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(summary.converged) << summary.message;
  EXPECT_GT(failures, 0);
  EXPECT_NEAR(problem.block(block)[0], std::exp(-3.0), 1e-8);
}

TEST(LeastSquares, IterationLimitIsNotConvergence) {
  LeastSquares problem;
  const int block = problem.add_block({1.0, 0.0});
  problem.add_residuals({block}, 20, exponential(exponential_data(2.5, -1.3, 20)));
  LeastSquares::Options options;
  options.max_iterations = 1;
  const auto summary = problem.solve(options);
  EXPECT_FALSE(summary.converged);
  EXPECT_TRUE(summary.usable);
  EXPECT_EQ(summary.message, "iteration limit: the sum of squares may still fall");
}

/// The exponential, at whose evaluation number `last` the work is stopped.
template <class Stop>
LeastSquares::Evaluate stopped_at(int last, int& calls) {
  return [evaluate = exponential(exponential_data(2.0, -1.5, 20)), last, &calls](const double* const* p, double* r, double** J) {
    if (++calls >= last) {
      if constexpr (std::is_same_v<Stop, TimeLimitReached>) throw TimeLimitReached("the time limit of 1 s for this was spent");
      throw Interrupted();
    }
    return evaluate(p, r, J);
  };
}

TEST(LeastSquares, EndsWithTheBestPointWhenItsTimeIsSpent) {
  double before = inf;
  for (const int last : {4, 5, 6, 7}) {
    int calls = 0;
    LeastSquares problem;
    const int block = problem.add_block({1.0, 0.0});
    problem.add_residuals({block}, 20, stopped_at<TimeLimitReached>(last, calls));
    const auto summary = problem.solve({});
    EXPECT_TRUE(summary.out_of_time);
    EXPECT_TRUE(summary.usable);
    EXPECT_FALSE(summary.converged);
    EXPECT_EQ(summary.message, "the time limit of 1 s for this was spent");
    EXPECT_EQ(calls, last) << "nothing is evaluated after it";
    double squares = 0.0;
    for (int i = 0; i < 20; ++i)
      squares += std::pow(problem.block(block)[0] * std::exp(problem.block(block)[1] * 0.1 * i) - 2.0 * std::exp(-0.15 * i), 2);
    EXPECT_NEAR(summary.cost, 0.5 * squares, 1e-12) << "the values are those of the cost";
    EXPECT_LE(summary.cost, before);
    before = summary.cost;
  }
  EXPECT_LT(before, 3.0) << "the start has 4.5";
}

TEST(LeastSquares, TimeSpentAtTheStartLeavesTheStart) {
  int calls = 0;
  LeastSquares problem;
  const int block = problem.add_block({1.0, 0.0});
  problem.add_residuals({block}, 20, stopped_at<TimeLimitReached>(1, calls));
  const auto summary = problem.solve({});
  EXPECT_TRUE(summary.out_of_time);
  EXPECT_FALSE(summary.usable);
  EXPECT_EQ(problem.block(block), (std::vector{1.0, 0.0}));
}

TEST(LeastSquares, AnInterruptComesThrough) {
  int calls = 0;
  LeastSquares problem;
  problem.add_residuals({problem.add_block({1.0, 0.0})}, 20, stopped_at<Interrupted>(4, calls));
  EXPECT_THROW(std::ignore = problem.solve({}), Interrupted);
  EXPECT_EQ(calls, 4);
}

TEST(LeastSquares, StartOutsideItsBoundsIsNamed) {
  LeastSquares problem;
  const int block = problem.add_block({1.0, 7.5}, {0.0, 0.0}, {2.0, 2.0});
  problem.add_residuals({block}, 20, exponential(exponential_data(2.5, 1.3, 20)));
  const auto summary = problem.solve({});
  EXPECT_FALSE(summary.usable);
  EXPECT_NE(summary.message.find("7.5 is outside its bounds [0, 2]"), std::string::npos) << summary.message;
}

TEST(LeastSquares, WrongSizesAreRefusedWhenAdded) {
  LeastSquares problem;
  EXPECT_THROW(problem.add_block({}), std::invalid_argument);
  EXPECT_THROW(problem.add_block({1.0, 2.0}, {0.0}), std::invalid_argument);
  const int block = problem.add_block({1.0});
  EXPECT_THROW(problem.add_residuals({block}, 0, pull_to(1.0)), std::invalid_argument);
  EXPECT_THROW(problem.add_residuals({block + 1}, 1, pull_to(1.0)), std::out_of_range);
  EXPECT_THROW(problem.add_residuals({block}, 1, pull_to(1.0), {LeastSquares::Loss::huber, 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace misfit
