#include "misfit/math/bfgs.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

TEST(BfgsInverse, WithoutUpdatesIsTheInitialOne) {
  const Eigen::MatrixXd initial = Eigen::Vector2d(3.0, 0.5).asDiagonal();
  EXPECT_EQ(BfgsInverse().inverse(initial), initial);
}

/// −½ xᵀAx with updates along three conjugate directions: the inverse of A, whatever the initial one.
TEST(BfgsInverse, IsExactForAQuadraticAfterConjugateSteps) {
  Eigen::MatrixXd A(3, 3);
  A << 4.0, 1.0, 0.5, 1.0, 3.0, -0.7, 0.5, -0.7, 2.0;
  const SymmetricEigen axes = symmetric_eigen(A);
  BfgsInverse bfgs;
  Eigen::VectorXd x = Eigen::Vector3d(1.0, -2.0, 0.3);
  bfgs.update(x, -A * x);
  for (Eigen::Index k = 0; k < 3; ++k) {
    x += (0.3 + static_cast<double>(k)) * axes.vectors.col(k);
    bfgs.update(x, -A * x);
  }
  const Eigen::MatrixXd found = bfgs.inverse(100.0 * Eigen::MatrixXd::Identity(3, 3));
  EXPECT_LT((found - inverse(A)).norm(), 1e-10 * found.norm());
}

TEST(BfgsInverse, IgnoresStepsAlongWhichTheObjectiveIsConvex) {
  BfgsInverse bfgs;
  const Eigen::MatrixXd initial = Eigen::MatrixXd::Identity(2, 2);
  bfgs.update(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1.0, 0.0));
  bfgs.update(Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(2.0, 0.0));
  EXPECT_EQ(bfgs.inverse(initial), initial);
}

/// Steps up Rosenbrock's ridge, (1 − x)² + 100 (y − x²)² from below, until it gains less than 1e-8; each halved until it rises.
int steps_up_the_ridge(bool with_bfgs) {
  const auto height = [](const Eigen::VectorXd& x) { return -std::pow(1.0 - x[0], 2) - 100.0 * std::pow(x[1] - x[0] * x[0], 2); };
  const Eigen::MatrixXd initial = Eigen::MatrixXd::Identity(2, 2) / 200.0;
  BfgsInverse bfgs;
  Eigen::VectorXd x = Eigen::Vector2d(-1.2, 1.0);
  constexpr int most = 5000;
  for (int k = 0; k < most; ++k) {
    const double off = x[1] - x[0] * x[0];
    const Eigen::VectorXd gradient = Eigen::Vector2d(2.0 * (1.0 - x[0]) + 400.0 * x[0] * off, -200.0 * off);
    bfgs.update(x, gradient);
    const Eigen::VectorXd step = (with_bfgs ? bfgs.inverse(initial) : initial) * gradient;
    double share = 1.0;
    while (height(x + share * step) <= height(x) && share > 1e-12) share *= 0.5;
    if (height(x + share * step) - height(x) < 1e-8) return (x - Eigen::Vector2d(1.0, 1.0)).norm() < 1e-2 ? k : most;
    x += share * step;
  }
  return most;
}

TEST(BfgsInverse, ClimbsACurvedRidgeInFewSteps) {
  EXPECT_LT(steps_up_the_ridge(true), 60);
  EXPECT_GT(steps_up_the_ridge(false), 600);
}

}  // namespace
}  // namespace misfit
