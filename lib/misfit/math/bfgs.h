#pragma once

#include <Eigen/Core>
#include <vector>

namespace misfit {

/// BFGS (Nocedal and Wright, Numerical Optimization (2006), 6.1) for maximising: updates an initial inverse of the objective's negative
/// Hessian by the changes of the gradient along the iterations. For likelihoods the initial one is the inverse Fisher information, which is
/// right if the model is; if it is not, and the noise accounts for what is missing, the likelihood can be far less curved, or curved along
/// a ridge, and steps by the information alone converge slowly.
class BfgsInverse {
 public:
  /// The gradient of the objective at the next iterate. Without effect where the objective is not concave along the step.
  void update(const Eigen::VectorXd& at, const Eigen::VectorXd& gradient);
  /// `initial`: positive definite, and so is the result.
  [[nodiscard]] Eigen::MatrixXd inverse(const Eigen::MatrixXd& initial) const;
  [[nodiscard]] bool has_updates() const { return !pairs_.empty(); }

 private:
  struct Pair {
    Eigen::VectorXd step, decrease;  ///< of the gradient along the step
  };
  std::vector<Pair> pairs_;
  Eigen::VectorXd at_, gradient_;
};

}  // namespace misfit
