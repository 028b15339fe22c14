#include "misfit/math/bfgs.h"

namespace misfit {

void BfgsInverse::update(const Eigen::VectorXd& at, const Eigen::VectorXd& gradient) {
  if (at_.size() == at.size()) {
    const Eigen::VectorXd step = at - at_, decrease = gradient_ - gradient;
    constexpr double min_cosine = 1e-12;
    if (step.dot(decrease) > min_cosine * step.norm() * decrease.norm()) pairs_.push_back({step, decrease});
  }
  at_ = at;
  gradient_ = gradient;
}

Eigen::MatrixXd BfgsInverse::inverse(const Eigen::MatrixXd& initial) const {
  Eigen::MatrixXd H = initial;
  for (const auto& [step, decrease] : pairs_) {
    const double rho = 1.0 / step.dot(decrease);
    const Eigen::VectorXd product = H * decrease;
    H += rho * (1.0 + rho * decrease.dot(product)) * (step * step.transpose()) -
         rho * (product * step.transpose() + step * product.transpose());
  }
  return H;
}

}  // namespace misfit
