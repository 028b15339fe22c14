#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace misfit {

/// Square root of a variance of the diagonal; 0 where rounding has made it negative.
[[nodiscard]] inline double standard_error(const Eigen::MatrixXd& covariance, Eigen::Index at) {
  return std::sqrt(std::max(covariance(at, at), 0.0));
}
/// The same of `weights` · unknowns.
template <class Covariance, class Weights>
[[nodiscard]] double standard_error_of_sum(const Eigen::MatrixBase<Covariance>& covariance, const Eigen::MatrixBase<Weights>& weights) {
  return std::sqrt(std::max(weights.dot(covariance * weights), 0.0));
}

/// Eigenvectors of the correlation matrix, scaled back to the unknowns. Those of the covariance itself would depend on the units.
struct CorrelationAxes {
  Eigen::MatrixXd along;  ///< columns: a step of one sigma along each axis, the best determined direction first
  Eigen::MatrixXd back;   ///< inverse of `along`
};
[[nodiscard]] CorrelationAxes correlation_axes(const Eigen::MatrixXd& covariance);

}  // namespace misfit
