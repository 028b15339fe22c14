#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

namespace misfit {

/// Eigen's decompositions of real matrices of any size, compiled once: as templates they cost every file that names one 3 to 20 s of
/// compilation (g++ 12), several times what the rest of it does. What Eigen's documentation says of each method holds. Small matrices whose
/// size is known when compiling stay Eigen's own where they are hot.

/// A = V diag(values) Vᵀ of a symmetric matrix (its lower triangle is read; Eigen::SelfAdjointEigenSolver).
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< in rising order
  Eigen::MatrixXd vectors;  ///< orthonormal columns
  bool converged = false;   ///< false for a matrix that is not finite

  /// V diag(f) Vᵀ.
  [[nodiscard]] Eigen::MatrixXd with(const Eigen::VectorXd& f) const { return vectors * f.asDiagonal() * vectors.transpose(); }
};
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);
/// A v = value B v of a symmetric A and a positive definite B; vectors with vᵀ B v = 1 (Eigen::GeneralizedSelfAdjointEigenSolver).
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// Of any square matrix, in no order.
[[nodiscard]] Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);

/// The Hermitian matrix nearest to a Hermitian A (in the Frobenius norm) that has no negative eigenvalue.
[[nodiscard]] Eigen::MatrixXcd nearest_positive_semidefinite(const Eigen::MatrixXcd& A);

/// Singular values in falling order, and the right singular vectors: one per column of A, those of its null space last.
struct RightSingular {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
[[nodiscard]] RightSingular right_singular(const Eigen::MatrixXd& A);

/// Σ Aᵏ/k!
[[nodiscard]] Eigen::MatrixXd exponential(const Eigen::MatrixXd& A);

/// By LU with partial pivoting: infinite or NaN where A is singular.
[[nodiscard]] Eigen::MatrixXd inverse(const Eigen::MatrixXd& A);
/// A⁻¹ of a symmetric matrix, and A⁻¹ b (LDLᵀ, pivoted: also semidefinite).
[[nodiscard]] Eigen::MatrixXd symmetric_inverse(const Eigen::MatrixXd& A);
[[nodiscard]] Eigen::VectorXd symmetric_solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
[[nodiscard]] Eigen::MatrixXd symmetric_solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
/// A⁻¹ B by LU with full pivoting; none unless the estimated reciprocal condition of A is above `least_condition`.
[[nodiscard]] std::optional<Eigen::MatrixXd> solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, double least_condition);

/// Of the X with the smallest |A X − B| the smallest one, also of a singular A (complete orthogonal decomposition); B = I: pseudoinverse.
[[nodiscard]] Eigen::MatrixXd minimum_norm_solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
[[nodiscard]] Eigen::MatrixXd pseudoinverse(const Eigen::MatrixXd& A);

/// Lower L with L Lᵀ = A; none unless A is positive definite.
[[nodiscard]] std::optional<Eigen::MatrixXd> cholesky(const Eigen::MatrixXd& A);

/// The X of the smallest |A X − B|, column by column (QR, columns pivoted); columns of A whose pivot is below `threshold` of the largest
/// are taken for dependent on the others, and get 0. kRounding: as Eigen chooses it.
inline constexpr double kRounding = -1.0;
[[nodiscard]] Eigen::MatrixXd least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, double threshold = kRounding);
/// An orthonormal basis of what the columns of A span (the same QR).
[[nodiscard]] Eigen::MatrixXd column_space(const Eigen::MatrixXd& A);

}  // namespace misfit
