#include "misfit/math/decompositions.h"

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

namespace misfit {
namespace {

template <class Solver>
SymmetricEigen results_of(const Solver& solver) {
  const bool converged = solver.info() == Eigen::Success && solver.eigenvalues().allFinite();  // Eigen calls NaN a success
  return {solver.eigenvalues(), solver.eigenvectors(), converged};
}

}  // namespace

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A) {
  if (A.size() == 0) return {{}, {}, true};
  return results_of(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A));
}

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return results_of(Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(A, B));
}

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) { return Eigen::EigenSolver<Eigen::MatrixXd>(A, false).eigenvalues(); }

Eigen::MatrixXcd nearest_positive_semidefinite(const Eigen::MatrixXcd& A) {
  // [Re A, -Im A; Im A, Re A] is symmetric, has each eigenvalue of A twice, and what is nearest to it has the same blocks.
  const Eigen::Index n = A.rows();
  Eigen::MatrixXd real(2 * n, 2 * n);
  real << A.real(), -A.imag(), A.imag(), A.real();
  const SymmetricEigen eigen = symmetric_eigen(real);
  if (eigen.values[0] >= 0.0) return A;
  const Eigen::MatrixXd nearest = eigen.with(eigen.values.cwiseMax(0.0));
  Eigen::MatrixXcd out(n, n);
  out.real() = nearest.topLeftCorner(n, n);
  out.imag() = nearest.bottomLeftCorner(n, n);
  return out;
}

RightSingular right_singular(const Eigen::MatrixXd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixV()};
}

Eigen::MatrixXd exponential(const Eigen::MatrixXd& A) { return A.exp(); }

Eigen::MatrixXd inverse(const Eigen::MatrixXd& A) { return A.inverse(); }

Eigen::MatrixXd symmetric_inverse(const Eigen::MatrixXd& A) { return A.ldlt().solve(Eigen::MatrixXd::Identity(A.rows(), A.cols())); }

Eigen::VectorXd symmetric_solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) { return A.ldlt().solve(b); }

Eigen::MatrixXd symmetric_solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) { return A.ldlt().solve(B); }

std::optional<Eigen::MatrixXd> solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, double least_condition) {
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(A);
  if (!lu.isInvertible() || !(lu.rcond() > least_condition)) return std::nullopt;  // rcond() of a singular matrix means nothing
  return lu.solve(B);
}

Eigen::MatrixXd minimum_norm_solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.completeOrthogonalDecomposition().solve(B);
}

Eigen::MatrixXd pseudoinverse(const Eigen::MatrixXd& A) { return A.completeOrthogonalDecomposition().pseudoInverse(); }

std::optional<Eigen::MatrixXd> cholesky(const Eigen::MatrixXd& A) {
  const Eigen::LLT<Eigen::MatrixXd> factor(A);
  if (factor.info() != Eigen::Success || !A.allFinite()) return std::nullopt;
  return factor.matrixL();
}

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, double threshold) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
  if (threshold >= 0.0) qr.setThreshold(threshold);
  const Eigen::Index rank = qr.rank();  // Eigen's solve() goes by what is exactly 0 instead
  const Eigen::MatrixXd rotated = qr.householderQ().adjoint() * B;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(A.cols(), B.cols());
  out.topRows(rank) = qr.matrixR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>().solve(rotated.topRows(rank));
  return qr.colsPermutation() * out;
}

Eigen::MatrixXd column_space(const Eigen::MatrixXd& A) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
  return qr.householderQ() * Eigen::MatrixXd::Identity(A.rows(), qr.rank());
}

}  // namespace misfit
