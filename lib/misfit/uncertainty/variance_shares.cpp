#include "misfit/uncertainty/variance_shares.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace misfit {

ShareRegression::ShareRegression(const Sampler& sampler)
    : term_of_factor_(sampler.term_of_factor()), terms_(sampler.term_names().size()), factors_(std::ssize(term_of_factor_)) {
  for (std::size_t i = 0; i < term_of_factor_.size(); ++i) uniform_.push_back(sampler.is_uniform(i));
  const Eigen::Index unknowns = 1 + 2 * factors_;
  N_ = Eigen::MatrixXd::Zero(unknowns, unknowns);
  g_ = Eigen::VectorXd::Zero(unknowns);
  row_ = Eigen::VectorXd::Ones(unknowns);
}

void ShareRegression::add(const std::vector<double>& factors, double number) {
  if (count_ == 0.0) origin_ = number;  // sums about a value close to the mean
  const double y = number - origin_;
  for (Eigen::Index i = 0; i < factors_; ++i) {
    const std::size_t k = i;
    const double z = factors[k];  // of variance 1 in both cases
    row_[1 + i] = z;
    row_[1 + factors_ + i] = (z * z - 1.0) * (uniform_[k] ? std::sqrt(5.0) / 2.0 : 1.0 / std::sqrt(2.0));
  }
  N_.noalias() += row_ * row_.transpose();
  g_ += row_ * y;
  squares_ += y * y;
  count_ += 1.0;
}

VarianceShares ShareRegression::shares() const {
  constexpr double runs_per_unknown = 10.0;
  for (const Eigen::Index unknowns : {1 + 2 * factors_, 1 + factors_}) {
    const bool enough = count_ >= (unknowns == 1 + factors_ ? 2.0 : runs_per_unknown) * static_cast<double>(unknowns) + 2.0;
    if (enough && factors_ > 0) return solve(unknowns);
  }
  return {};
}

VarianceShares ShareRegression::solve(Eigen::Index unknowns) const {
  VarianceShares out;
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(N_.topLeftCorner(unknowns, unknowns));
  const Eigen::VectorXd c = ldlt.solve(g_.head(unknowns));
  const Eigen::MatrixXd inverse = ldlt.solve(Eigen::MatrixXd::Identity(unknowns, unknowns));
  const double left = std::max(squares_ - c.dot(g_.head(unknowns)), 0.0) / (count_ - static_cast<double>(unknowns));
  // Own variances of the coefficients make their squares too large; together they may not make the whole negative.
  const auto square = [&](Eigen::Index i) { return std::max(c[i] * c[i] - left * inverse(i, i), 0.0); };
  double variance = left;
  for (Eigen::Index i = 1; i < unknowns; ++i) variance += square(i);
  constexpr double rounding = 1e-20;  // of the square: a number that did not change
  if (!(variance > rounding * (origin_ * origin_ + squares_ / count_))) return out;
  out.quadratic = unknowns > 1 + factors_;
  out.share.assign(terms_, 0.0);
  out.sigma.assign(terms_, 0.0);
  out.effect.assign(terms_, 0.0);
  std::vector<int> members(terms_, 0);
  for (Eigen::Index i = 1; i < unknowns; ++i) {
    const std::size_t term = term_of_factor_[(i - 1) % factors_];
    const double own = left * inverse(i, i);
    out.share[term] += square(i) / variance;
    out.sigma[term] += (4.0 * c[i] * c[i] * own + 2.0 * own * own) / (variance * variance);
    if (i > factors_) continue;
    out.effect[term] = c[i];
    ++members[term];
  }
  out.rest = left / variance;
  for (std::size_t t = 0; t < terms_; ++t) {
    out.sigma[t] = std::sqrt(out.sigma[t]);
    if (members[t] > 1) out.effect[t] = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

}  // namespace misfit
