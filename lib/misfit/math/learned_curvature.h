#pragma once

#include <Eigen/Core>
#include <vector>

namespace misfit {

/// What the gradients along a climb say of an objective's curvature, on top of an inverse that is only expected to be its own: BFGS
/// (Nocedal and Wright, Numerical Optimization (2006), 6.1). For likelihoods that is the inverse of the Fisher information: right where the
/// model is. Where it is wrong, and the noise stands in for what is missing, the likelihood can be far less curved, or bent along a ridge,
/// and steps by the information alone creep.
class LearnedCurvature {
 public:
  /// The gradient of the objective at the next point of the climb. A step along which the objective does not bend downwards teaches
  /// nothing.
  void look(const Eigen::VectorXd& at, const Eigen::VectorXd& gradient);
  /// `expected`: positive definite, and so is the result.
  [[nodiscard]] Eigen::MatrixXd inverse(const Eigen::MatrixXd& expected) const;
  [[nodiscard]] bool anything() const { return !pairs_.empty(); }

 private:
  struct Pair {
    Eigen::VectorXd step, fall;  ///< of the gradient along the step
  };
  std::vector<Pair> pairs_;
  Eigen::VectorXd at_, gradient_;
};

}  // namespace misfit
