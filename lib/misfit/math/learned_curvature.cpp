#include "misfit/math/learned_curvature.h"

namespace misfit {

void LearnedCurvature::look(const Eigen::VectorXd& at, const Eigen::VectorXd& gradient) {
  if (at_.size() == at.size()) {
    const Eigen::VectorXd step = at - at_, fall = gradient_ - gradient;
    constexpr double least = 1e-12;
    if (step.dot(fall) > least * step.norm() * fall.norm()) pairs_.push_back({step, fall});
  }
  at_ = at;
  gradient_ = gradient;
}

Eigen::MatrixXd LearnedCurvature::inverse(const Eigen::MatrixXd& expected) const {
  Eigen::MatrixXd H = expected;
  for (const auto& [step, fall] : pairs_) {
    const double rho = 1.0 / step.dot(fall);
    const Eigen::VectorXd moved = H * fall;
    H += rho * (1.0 + rho * fall.dot(moved)) * (step * step.transpose()) - rho * (moved * step.transpose() + step * moved.transpose());
  }
  return H;
}

}  // namespace misfit
