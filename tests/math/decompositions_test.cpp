#include "misfit/math/decompositions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>

namespace {

using namespace misfit;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd two_by_two(double a, double b, double c, double d) {
  MatrixXd out(2, 2);
  out << a, b, c, d;
  return out;
}

TEST(Decompositions, OfASymmetricMatrixAreItsAxesInRisingOrder) {
  const SymmetricEigen axes = symmetric_eigen(two_by_two(2, 1, 1, 2));
  EXPECT_TRUE(axes.converged);
  EXPECT_NEAR(axes.values[0], 1.0, 1e-14);
  EXPECT_NEAR(axes.values[1], 3.0, 1e-14);
  EXPECT_NEAR(std::abs(axes.vectors.col(1).dot(VectorXd::Constant(2, std::sqrt(0.5)))), 1.0, 1e-14);
  EXPECT_TRUE(axes.with(axes.values.cwiseInverse()).isApprox(two_by_two(2, -1, -1, 2) / 3.0, 1e-14));
  EXPECT_EQ(symmetric_eigen(MatrixXd(0, 0)).values.size(), 0);
}

TEST(Decompositions, OfAMatrixThatIsNotFiniteSaySo) {
  EXPECT_FALSE(symmetric_eigen(two_by_two(std::nan(""), 1, 1, 2)).converged);
  EXPECT_FALSE(cholesky(two_by_two(std::nan(""), 0, 0, 1)));
  EXPECT_FALSE(solve(two_by_two(std::nan(""), 0, 0, 1), VectorXd::Ones(2), 1e-12));
}

TEST(Decompositions, OfTwoMatricesHaveAxesOfUnitLengthInTheSecond) {
  const MatrixXd B = two_by_two(4, 0, 0, 1);
  const SymmetricEigen axes = symmetric_eigen(two_by_two(8, 0, 0, 5), B);
  EXPECT_NEAR(axes.values[0], 2.0, 1e-14);
  EXPECT_NEAR(axes.values[1], 5.0, 1e-14);
  EXPECT_TRUE((axes.vectors.transpose() * B * axes.vectors).isApprox(MatrixXd::Identity(2, 2), 1e-14));
}

TEST(Decompositions, GiveAnOscillatorItsPolesAndItsTransition) {
  constexpr double frequency = 3.0, damping = 0.5, h = 0.7;
  const MatrixXd A = two_by_two(0, 1, -frequency * frequency - damping * damping, -2.0 * damping);
  const Eigen::VectorXcd poles = eigenvalues(A);
  EXPECT_NEAR(std::abs(poles[0].imag()), frequency, 1e-13);
  EXPECT_NEAR(poles[0].real(), -damping, 1e-13);
  const double decay = std::exp(-damping * h), c = std::cos(frequency * h), s = std::sin(frequency * h) / frequency;
  const MatrixXd exact = decay * two_by_two(c + damping * s, s, -(frequency * frequency + damping * damping) * s, c - damping * s);
  EXPECT_TRUE(exponential(A * h).isApprox(exact, 1e-13));
}

TEST(Decompositions, FindTheNearestDensityWithoutNegativePower) {
  using namespace std::complex_literals;
  Eigen::MatrixXcd A(2, 2);
  A << 1.0, -2i, 2i, 1.0;  // eigenvalues -1 and 3; that of 3: (1, i)/sqrt 2
  Eigen::MatrixXcd expected(2, 2);
  expected << 1.5, -1.5i, 1.5i, 1.5;
  EXPECT_TRUE(nearest_positive_semidefinite(A).isApprox(expected, 1e-14));
  EXPECT_TRUE(nearest_positive_semidefinite(expected).isApprox(expected, 1e-14));
}

TEST(Decompositions, HaveTheNullSpaceOfAWideMatrixLast) {
  MatrixXd A(2, 3);
  A << 1, 0, -1, 0, 1, -1;
  const RightSingular all = right_singular(A);
  EXPECT_NEAR(all.values[0], std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(all.values[1], 1.0, 1e-14);
  EXPECT_NEAR(std::abs(all.vectors.col(2).dot(VectorXd::Constant(3, 1.0 / std::sqrt(3.0)))), 1.0, 1e-14);
}

TEST(Decompositions, SolveWhatCanBeSolved) {
  const MatrixXd A = two_by_two(2, 1, 1, 2), turn = two_by_two(0, 2, -1, 0);
  const VectorXd b = VectorXd::LinSpaced(2, 3.0, 0.0);
  EXPECT_TRUE(symmetric_solve(A, b).isApprox(VectorXd::LinSpaced(2, 2.0, -1.0), 1e-14));
  EXPECT_TRUE((symmetric_solve(A, turn) - A.inverse() * turn).isZero(1e-14));
  EXPECT_TRUE((symmetric_inverse(A) * A).isIdentity(1e-14));
  EXPECT_TRUE((inverse(turn) * turn).isIdentity(1e-14));
  ASSERT_TRUE(solve(turn, b, 0.1));
  EXPECT_TRUE((turn * *solve(turn, b, 0.1)).isApprox(b, 1e-14));
  EXPECT_FALSE(solve(two_by_two(1, 2, 2, 4), b, 1e-12)) << "singular";
  EXPECT_FALSE(solve(two_by_two(1, 0, 0, 1e-6), b, 1e-3)) << "its condition is 1e-6";
}

TEST(Decompositions, GiveTheSmallestOfManySolutions) {
  const MatrixXd A = two_by_two(1, 1, 1, 1);  // x + y = 2: (1, 1) is nearest to 0
  EXPECT_TRUE(minimum_norm_solve(A, VectorXd::Constant(2, 2.0)).isApprox(VectorXd::Ones(2), 1e-14));
  EXPECT_TRUE(pseudoinverse(A).isApprox(0.25 * A, 1e-14));
}

TEST(Decompositions, HaveARootOfAPositiveDefiniteMatrixAlone) {
  const MatrixXd A = two_by_two(4, 2, 2, 5);
  ASSERT_TRUE(cholesky(A));
  EXPECT_TRUE(cholesky(A)->isApprox(two_by_two(2, 0, 1, 2), 1e-14));
  EXPECT_FALSE(cholesky(two_by_two(1, 2, 2, 1)));
}

TEST(Decompositions, GiveADependentColumnNothing) {
  MatrixXd A(3, 2), B(3, 1);
  A << 1, 1, 1, 1 + 1e-8, 1, 1 - 1e-8;
  B << 2, 2, 2;
  const MatrixXd told_apart = least_squares(A, B), not_told_apart = least_squares(A, B, 1e-6);
  EXPECT_TRUE((A * told_apart - B).isZero(1e-12));
  EXPECT_EQ((not_told_apart.array() == 0.0).count(), 1);
  EXPECT_TRUE((A * not_told_apart - B).isZero(1e-7));
  MatrixXd same(3, 2);
  same << 1, 2, 2, 4, 2, 4;
  const MatrixXd Q = column_space(same);
  ASSERT_EQ(Q.cols(), 1);
  EXPECT_NEAR(std::abs(Q.col(0).dot(same.col(0))), 3.0, 1e-14);
}

}  // namespace
