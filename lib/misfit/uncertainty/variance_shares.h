#pragma once

// References
//   [Sa] A. Saltelli et al., Global Sensitivity Analysis: The Primer (2008): first-order index S_j = Var(E[y | x_j]) / Var(y).
//   [Su] B. Sudret, Reliab. Eng. Syst. Saf. 93 (2008): these indices from the coefficients of an orthonormal polynomial regression.

#include <Eigen/Core>
#include <vector>

#include "misfit/uncertainty/perturbation.h"

namespace misfit {

/// Which part of the variance of one number comes from each term of a sampler, at first order.
struct VarianceShares {
  std::vector<double> share;   ///< per term: between 0 and 1 but for noise; empty: too few runs
  std::vector<double> sigma;   ///< of the share
  std::vector<double> effect;  ///< change of the number per one sigma of the term's parameter [unit of the number]; NaN for groups
  double rest = 0.0;           ///< residual variance: what acts together or beyond the polynomials; shares and rest add up to 1
  bool quadratic = false;      ///< the regression had squares of the factors
};

/// Least squares of the number on polynomials of the factors, orthonormal under their distribution (Hermite for normal, Legendre for
/// uniform ones): 1, P1(z_i) and, where there are at least ten runs per unknown, P2(z_i). The share of a term is Σ c² over the polynomials
/// of its factors alone, over the sum of all c² and the residual variance [Su]; c² is lessened by its own variance, by which it is too
/// large on average. Factors of a group are those that its covariance was whitened with: their squares are in, their products are not.
/// Holds sums only: memory does not grow with the runs. Runs must be added in the same order to give the same bits.
class ShareRegression {
 public:
  explicit ShareRegression(const Sampler& sampler);
  void add(const std::vector<double>& factors, double number);
  [[nodiscard]] VarianceShares shares() const;

 private:
  [[nodiscard]] VarianceShares solve(Eigen::Index unknowns) const;

  std::vector<std::size_t> term_of_factor_;
  std::vector<bool> uniform_;
  std::size_t terms_ = 0;
  Eigen::Index factors_ = 0;
  double count_ = 0.0, origin_ = 0.0;
  Eigen::MatrixXd N_;  ///< of the row [1, P1…, P2…]
  Eigen::VectorXd g_;
  double squares_ = 0.0;
  Eigen::VectorXd row_;
};

}  // namespace misfit
