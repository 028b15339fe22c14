#include "misfit/inference/roughness.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace misfit {
namespace {

/// Where a curve is a straight line to all that the data can tell: a higher weight would only cost digits (λ Ω c of a line is rounding).
double max_lambda(const NormalEquations& problem, const Penalty& p, double sigma2) {
  constexpr double straight = 1e9;
  const auto size = p.omega.rows();
  return straight * problem.N.block(p.first, p.first, size, size).trace() / (sigma2 * p.omega.trace());
}

}  // namespace

Eigen::MatrixXd precision_of(const NormalEquations& problem, const std::vector<Penalty>& penalties, double sigma2) {
  Eigen::MatrixXd H = problem.N / sigma2;
  H.diagonal() += problem.prior_precision;
  for (const auto& p : penalties) H.block(p.first, p.first, p.omega.rows(), p.omega.cols()) += p.lambda * p.omega;
  return H;
}

bool invert_scaled(const Eigen::MatrixXd& H, Eigen::MatrixXd& inverse) {
  const Eigen::VectorXd scale = H.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * H * scale.asDiagonal());
  if (factor.info() != Eigen::Success) return false;
  inverse = scale.asDiagonal() * factor.solve(Eigen::MatrixXd::Identity(H.rows(), H.cols())) * scale.asDiagonal();
  return inverse.allFinite();
}

PenaltyBasis penalty_eigenbasis(Eigen::Index columns, const std::vector<Penalty>& penalties) {
  PenaltyBasis out{Eigen::MatrixXd::Identity(columns, columns), penalties};
  for (Penalty& p : out.penalties) {
    const auto size = p.omega.rows();
    const auto bends = static_cast<Eigen::Index>(p.rank);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(p.omega);
    out.turn.block(p.first, p.first, size, size) = solver.eigenvectors();
    Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(size);
    stiffness.tail(bends) = solver.eigenvalues().tail(bends).cwiseMax(0.0);
    p.omega = stiffness.asDiagonal();
  }
  return out;
}

bool invert_with(const Eigen::MatrixXd& information, const PenaltyBasis& bends, Eigen::MatrixXd& inverse) {
  Eigen::MatrixXd H = bends.turn.transpose() * information * bends.turn, inside;
  for (const auto& p : bends.penalties) H.block(p.first, p.first, p.omega.rows(), p.omega.cols()) += p.lambda * p.omega;
  if (!invert_scaled(H, inside)) return false;
  inverse = bends.turn * inside * bends.turn.transpose();
  return true;
}

std::vector<Penalty> curve_penalties(const Model& model) {
  std::vector<Penalty> penalties;
  const std::vector<int> free = model.free_parameters();
  for (std::size_t k = 0; k < model.curves.size(); ++k) {
    const Curve& curve = model.curves[k];
    const auto column = std::find(free.begin(), free.end(), curve.first);
    if (column == free.end()) continue;
    Penalty p;
    p.curve = static_cast<int>(k);
    p.first = static_cast<int>(column - free.begin());
    p.omega = curve.spline.roughness();
    p.rank = curve.spline.size() - 2;
    p.chosen = !curve.roughness.has_value();
    const double range = curve.spline.highest() - curve.spline.lowest();
    constexpr double wiggles = 10.0;  // start loose: more structure than a parabola of typical size
    p.lambda = curve.roughness.value_or(std::pow(range, 3) / std::pow(wiggles * curve.scale, 2));
    penalties.push_back(std::move(p));
  }
  return penalties;
}

Model with_roughness(Model model, const std::vector<Penalty>& penalties) {
  for (const auto& p : penalties) model.curves[p.curve].roughness = p.lambda;
  return model;
}

PenalisedFit estimate_smoothing(const NormalEquations& problem, std::vector<Penalty>& penalties, double sigma2_given) {
  PenalisedFit out;
  double sigma2 = sigma2_given > 0.0 ? sigma2_given : std::max(problem.rss / std::max(problem.count, 1.0), 1e-300);
  PenaltyBasis bends = penalty_eigenbasis(problem.N.rows(), penalties);
  constexpr int most = 60;
  for (int round = 0; round < most; ++round) {
    if (!invert_with(precision_of(problem, {}, sigma2), bends, out.covariance)) return out;
    Eigen::VectorXd b = (problem.N * problem.theta - problem.g) / sigma2;
    b += problem.prior_precision.cwiseProduct(problem.prior_mean);
    out.theta = out.covariance * b;
    const Eigen::VectorXd d = out.theta - problem.theta;
    out.rss = std::max(problem.rss + 2.0 * d.dot(problem.g) + d.dot(problem.N * d), 1e-300);
    out.edf = (out.covariance * problem.N).trace() / sigma2 - problem.held;
    out.sigma2 = sigma2;
    out.ok = true;
    double change = 0.0;
    for (std::size_t k = 0; k < penalties.size(); ++k) {
      Penalty& p = penalties[k];
      if (!p.chosen) continue;
      const auto size = p.omega.rows();
      const Eigen::VectorXd c = out.theta.segment(p.first, size);
      const double trace = (out.covariance.block(p.first, p.first, size, size) * p.omega).trace();
      const double quadratic = std::max(c.dot(p.omega * c), 1e-300);
      const double target = std::max(p.rank - p.lambda * trace, 1e-3) / quadratic;
      const double next = std::min(std::clamp(target, p.lambda * 1e-2, p.lambda * 1e2), std::max(max_lambda(problem, p, sigma2), 1e-300));
      change = std::max(change, std::abs(std::log(next / p.lambda)));
      p.lambda = bends.penalties[k].lambda = next;
    }
    if (sigma2_given <= 0.0) {
      const double next = std::max(out.rss / std::max(problem.count - out.edf, 1.0), 1e-300);
      change = std::max(change, std::abs(std::log(next / sigma2)));
      sigma2 = next;
    }
    if (change < 1e-3) break;
  }
  return out;
}

Eigen::MatrixXd penalty_rows(const Penalty& penalty) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(penalty.omega);
  const Eigen::VectorXd values = (penalty.lambda * eigen.eigenvalues().cwiseMax(0.0)).cwiseSqrt();
  return values.asDiagonal() * eigen.eigenvectors().transpose();
}

void set_priors(const Model& model, NormalEquations& sums) {
  const std::vector<int> free = model.free_parameters();
  sums.prior_precision = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(free.size()));
  sums.prior_mean = sums.prior_precision;
  for (std::size_t c = 0; c < free.size(); ++c) {
    const Parameter& p = model.parameters[static_cast<std::size_t>(free[c])];
    const auto i = static_cast<Eigen::Index>(c);
    // Without a prior a coefficient that no sample touches would be free to be anything: a very wide one (1000 typical sizes) keeps it
    // finite.
    constexpr double very_wide = 1e3;
    sums.prior_precision[i] = 1.0 / std::pow(p.prior_sigma.value_or(very_wide * p.scale), 2);
    sums.prior_mean[i] = p.prior_sigma ? p.prior_mean : 0.0;
  }
}

}  // namespace misfit
