#include "misfit/inference/roughness.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

/// At this λ the data cannot distinguish the curve from a straight line: a higher one would only cost digits (λ Ω c of a line is rounding).
double max_lambda(const NormalEquations& problem, const Penalty& p, double sigma2) {
  constexpr double lambda_of_a_line = 1e9;  // over the mean information per mean stiffness
  const auto size = p.omega.rows();
  return lambda_of_a_line * problem.N.block(p.first, p.first, size, size).trace() / (sigma2 * p.omega.trace());
}

}  // namespace

Eigen::MatrixXd precision_of(const NormalEquations& problem, const std::vector<Penalty>& penalties, double sigma2) {
  Eigen::MatrixXd H = problem.N / sigma2;
  GaussianPrior{problem.prior, penalties}.add_precision(H);
  return H;
}

bool invert_scaled(const Eigen::MatrixXd& H, Eigen::MatrixXd& inverse, double* log_determinant) {
  const Eigen::VectorXd scale = H.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * H * scale.asDiagonal());
  if (factor.info() != Eigen::Success) return false;
  inverse = scale.asDiagonal() * factor.solve(Eigen::MatrixXd::Identity(H.rows(), H.cols())) * scale.asDiagonal();
  if (log_determinant != nullptr)
    *log_determinant = 2.0 * Eigen::MatrixXd(factor.matrixL()).diagonal().array().log().sum() - 2.0 * scale.array().log().sum();
  return inverse.allFinite();
}

PenaltyBasis penalty_eigenbasis(Eigen::Index columns, const std::vector<Penalty>& penalties) {
  PenaltyBasis out{Eigen::MatrixXd::Identity(columns, columns), penalties};
  for (Penalty& p : out.penalties) {
    const auto size = p.omega.rows();
    const SymmetricEigen eigen = symmetric_eigen(p.omega);
    out.Q.block(p.first, p.first, size, size) = eigen.vectors;
    Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(size);
    stiffness.tail(p.rank) = eigen.values.tail(p.rank).cwiseMax(0.0);
    p.omega = stiffness.asDiagonal();
  }
  return out;
}

bool invert_with(const Eigen::MatrixXd& information, const PenaltyBasis& basis, Eigen::MatrixXd& inverse) {
  Eigen::MatrixXd H = basis.Q.transpose() * information * basis.Q, inside;
  for (const auto& p : basis.penalties) H.block(p.first, p.first, p.omega.rows(), p.omega.cols()) += p.lambda * p.omega;
  if (!invert_scaled(H, inside)) return false;
  inverse = basis.Q * inside * basis.Q.transpose();
  return true;
}

namespace {

/// Maximum, covariance, residuals and effective parameters with the λ of `basis`; false: not positive definite.
bool solve_penalised(const NormalEquations& problem, const PenaltyBasis& basis, double sigma2, PenalisedFit& out) {
  if (!invert_with(precision_of(problem, {}, sigma2), basis, out.covariance)) return false;
  Eigen::VectorXd b = (problem.N * problem.theta - problem.g) / sigma2;
  b += problem.prior.precision.cwiseProduct(problem.prior.mean);
  out.theta = out.covariance * b;
  const Eigen::VectorXd d = out.theta - problem.theta;
  out.rss = std::max(problem.rss + 2.0 * d.dot(problem.g) + d.dot(problem.N * d), 1e-300);
  out.edf = (out.covariance * problem.N).trace() / sigma2 - problem.constraints;
  out.sigma2 = sigma2;
  out.ok = true;
  return true;
}

/// The Fellner–Schall update (rank − λ tr CΩ)/cᵀΩc, by no more than a hundred at once.
double updated_lambda(const Penalty& p, const PenalisedFit& fit, double largest) {
  const auto size = p.omega.rows();
  const Eigen::VectorXd c = fit.theta.segment(p.first, size);
  const double trace = (fit.covariance.block(p.first, p.first, size, size) * p.omega).trace();
  const double quadratic = std::max(c.dot(p.omega * c), 1e-300);
  const double target = std::max(p.rank - p.lambda * trace, 1e-3) / quadratic;
  return std::min(std::clamp(target, p.lambda * 1e-2, p.lambda * 1e2), std::max(largest, 1e-300));
}

}  // namespace

Eigen::VectorXd newton_step(const NormalEquations& problem, const std::vector<Penalty>& penalties, const Eigen::MatrixXd& covariance) {
  const PenaltyBasis basis = penalty_eigenbasis(problem.N.rows(), penalties);
  const Eigen::VectorXd rotated = basis.Q.transpose() * problem.theta;
  Eigen::VectorXd bend = Eigen::VectorXd::Zero(rotated.size());
  for (const Penalty& p : basis.penalties) {
    const Eigen::Index size = p.omega.rows();
    bend.segment(p.first, size) += p.lambda * (p.omega * rotated.segment(p.first, size));
  }
  return covariance * (problem.prior.gradient(problem.theta) - problem.g - basis.Q * bend);
}

PenalisedFit estimate_smoothing(const NormalEquations& problem, std::vector<Penalty>& penalties, double sigma2_given) {
  constexpr int max_rounds = 60;
  constexpr double negligible_change = 1e-3;  // of the logarithms of λ and σ²
  PenalisedFit out;
  double sigma2 = sigma2_given > 0.0 ? sigma2_given : std::max(problem.rss / std::max(problem.count, 1.0), 1e-300);
  PenaltyBasis basis = penalty_eigenbasis(problem.N.rows(), penalties);
  for (int round = 0; round < max_rounds; ++round) {
    if (!solve_penalised(problem, basis, sigma2, out)) return out;
    double change = 0.0;
    for (std::size_t k = 0; k < penalties.size(); ++k) {
      Penalty& p = penalties[k];
      if (!p.chosen) continue;
      const double next = updated_lambda(p, out, max_lambda(problem, p, sigma2));
      change = std::max(change, std::abs(std::log(next / p.lambda)));
      p.lambda = basis.penalties[k].lambda = next;
    }
    if (sigma2_given <= 0.0) {
      const double next = std::max(out.rss / std::max(problem.count - out.edf, 1.0), 1e-300);
      change = std::max(change, std::abs(std::log(next / sigma2)));
      sigma2 = next;
    }
    if (change < negligible_change) break;
  }
  return out;
}

double marginal_loglik(const NormalEquations& here, const std::vector<Penalty>& penalties, double objective) {
  if (here.theta.size() == 0) return objective;
  const PenaltyBasis basis = penalty_eigenbasis(here.N.rows(), penalties);
  Eigen::MatrixXd information = here.N;
  information.diagonal() += here.prior.precision;
  information = basis.Q.transpose() * information * basis.Q;
  for (const Penalty& p : basis.penalties) information.block(p.first, p.first, p.omega.rows(), p.omega.cols()) += p.lambda * p.omega;
  Eigen::MatrixXd inverse;
  double log_determinant = 0.0;
  if (!invert_scaled(information, inverse, &log_determinant)) return -std::numeric_limits<double>::infinity();
  double out = objective - 0.5 * log_determinant;
  for (const Penalty& p : penalties) out += p.log_normalisation();
  return out;
}

}  // namespace misfit
