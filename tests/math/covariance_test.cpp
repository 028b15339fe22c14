#include "misfit/math/covariance.h"

#include <gtest/gtest.h>

#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

/// Two unknowns of sigmas 2 and 1e-3 with the correlation 0.6: its matrix has the eigenvalues 0.4 and 1.6.
Eigen::MatrixXd example() {
  Eigen::MatrixXd out(2, 2);
  out << 4.0, 1.2e-3, 1.2e-3, 1e-6;
  return out;
}

TEST(Covariance, StandardErrorsOfUnknownsAndOfTheirSums) {
  EXPECT_DOUBLE_EQ(standard_error(example(), 0), 2.0);
  EXPECT_NEAR(standard_error_of_sum(example(), Eigen::Vector2d(1.0, 1000.0)), std::sqrt(4.0 + 2.4 + 1.0), 1e-12);
  Eigen::MatrixXd rounded(1, 1);
  rounded << -1e-20;
  EXPECT_EQ(standard_error(rounded, 0), 0.0);
}

TEST(Covariance, AxesAreThoseOfTheCorrelationMatrixInStepsOfOneSigma) {
  const CorrelationAxes axes = correlation_axes(example());
  for (const auto& [column, eigenvalue] : {std::pair(0, 0.4), std::pair(1, 1.6)}) {
    const Eigen::Vector2d step = axes.along.col(column);
    EXPECT_NEAR(step.dot(inverse(example()) * step), 1.0, 1e-9);
    EXPECT_NEAR(std::abs(step[0] / 2.0), std::sqrt(0.5 * eigenvalue), 1e-12);
    EXPECT_NEAR(std::abs(step[1] / 1e-3), std::sqrt(0.5 * eigenvalue), 1e-12);
  }
  EXPECT_NEAR((axes.back * axes.along - Eigen::MatrixXd::Identity(2, 2)).norm(), 0.0, 1e-9);
  EXPECT_EQ(correlation_axes({}).along.size(), 0);
}

}  // namespace
}  // namespace misfit
