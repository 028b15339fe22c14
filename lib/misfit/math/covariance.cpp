#include "misfit/math/covariance.h"

#include "misfit/math/decompositions.h"

namespace misfit {

CorrelationAxes correlation_axes(const Eigen::MatrixXd& covariance) {
  if (covariance.size() == 0) return {};
  constexpr double least_variance = 1e-300, smallest = 1e-14;  // eigenvalue that rounding leaves
  const Eigen::VectorXd sigma = covariance.diagonal().cwiseMax(least_variance).cwiseSqrt();
  const Eigen::MatrixXd correlation = sigma.cwiseInverse().asDiagonal() * covariance * sigma.cwiseInverse().asDiagonal();
  const SymmetricEigen axes = symmetric_eigen(correlation);
  const Eigen::VectorXd root = axes.values.cwiseMax(smallest).cwiseSqrt();
  return {sigma.asDiagonal() * axes.vectors * root.asDiagonal(),
          root.cwiseInverse().asDiagonal() * axes.vectors.transpose() * sigma.cwiseInverse().asDiagonal()};
}

}  // namespace misfit
