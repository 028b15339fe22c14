#include "misfit/math/covariance.h"

#include <Eigen/Dense>

namespace misfit {

CorrelationAxes correlation_axes(const Eigen::MatrixXd& covariance) {
  if (covariance.size() == 0) return {};
  constexpr double least_variance = 1e-300, smallest = 1e-14;  // eigenvalue that rounding leaves
  const Eigen::VectorXd sigma = covariance.diagonal().cwiseMax(least_variance).cwiseSqrt();
  const Eigen::MatrixXd correlation = sigma.cwiseInverse().asDiagonal() * covariance * sigma.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation);
  const Eigen::VectorXd root = solver.eigenvalues().cwiseMax(smallest).cwiseSqrt();
  return {sigma.asDiagonal() * solver.eigenvectors() * root.asDiagonal(),
          root.cwiseInverse().asDiagonal() * solver.eigenvectors().transpose() * sigma.cwiseInverse().asDiagonal()};
}

}  // namespace misfit
