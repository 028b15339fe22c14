#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "misfit/inference/roughness.h"

namespace misfit {
namespace {

/// The problem's Gaussian at one value of a λ.
struct LambdaPoint {
  Eigen::MatrixXd covariance;
  Eigen::VectorXd shift;                      ///< maximum less the problem's θ
  double lambda = 0.0, log_likelihood = 0.0;  ///< marginal one, but for what does not depend on λ

  /// Logarithm, under a uniform prior of 1/sqrt(λ).
  [[nodiscard]] double log_weight() const { return log_likelihood - 0.5 * std::log(lambda); }
};

/// The problem with one λ changed, in the PenaltyBasis.
class AlongLambda {
 public:
  AlongLambda(NormalEquations problem, const std::vector<Penalty>& penalties, double sigma2, const Eigen::MatrixXd& excess)
      : problem_(std::move(problem)), penalties_(penalties), sigma2_(sigma2), excess_(excess) {}

  /// The sum of with_uncertain_roughness(). Empty where the information is not positive definite.
  [[nodiscard]] Eigen::MatrixXd average() const {
    const std::optional<LambdaPoint> best = at(0, penalties_[0].lambda);
    if (!best) return {};
    const Eigen::MatrixXd at_best = with_excess(best->covariance);
    Eigen::MatrixXd out = at_best;
    for (std::size_t k = 0; k < penalties_.size(); ++k) {
      if (penalties_[k].chosen) out += integral_over(k, best->shift) - at_best;
    }
    return out;
  }

  /// nullopt where the information is not positive definite.
  [[nodiscard]] std::optional<LambdaPoint> at(std::size_t k, double lambda) const {
    GaussianPrior prior{problem_.prior, penalties_};
    Penalty& own = prior.penalties[k];
    own.lambda = lambda;
    LambdaPoint out;
    out.lambda = lambda;
    double log_determinant = 0.0;
    if (!invert_scaled(precision_of(problem_, prior.penalties, sigma2_), out.covariance, &log_determinant)) return std::nullopt;
    const Eigen::VectorXd slope = -problem_.g / sigma2_ + prior.gradient(problem_.theta);
    out.shift = out.covariance * slope;
    // −2 log density of data and unknowns at the maximum, but for what does not depend on λ_k.
    const Eigen::VectorXd c = problem_.theta.segment(own.first, own.omega.rows());
    const double cost = lambda * c.dot(own.omega * c) - slope.dot(out.shift);
    out.log_likelihood = own.log_normalisation() - 0.5 * log_determinant - 0.5 * cost;
    return out;
  }

 private:
  /// C + C E C.
  [[nodiscard]] Eigen::MatrixXd with_excess(const Eigen::MatrixXd& covariance) const {
    Eigen::MatrixXd out = covariance;
    if (excess_.size() > 0) out += covariance * excess_ * covariance;
    return out;
  }

  /// In steps of sqrt(10) down and up from the best λ, until the weight is negligible.
  [[nodiscard]] std::vector<LambdaPoint> points_of(std::size_t k) const {
    constexpr int max_steps = 40;
    constexpr double negligible = 10.0;  // of the logarithm of the weight
    const double step = std::sqrt(10.0), best = penalties_[k].lambda;
    std::vector<LambdaPoint> points;
    for (const double factor : {1.0 / step, step}) {
      double highest = -1e300;
      for (int i = factor < 1.0 ? 0 : 1; i < max_steps; ++i) {
        std::optional<LambdaPoint> point = at(k, best * std::pow(factor, i));
        if (!point) break;
        const double weight = point->log_weight();
        highest = std::max(highest, weight);
        points.push_back(std::move(*point));
        if (weight < highest - negligible) break;
      }
    }
    return points;
  }

  /// `shift`: that of the maximum at the λ that are used, which is not the problem's θ where a bound holds that.
  [[nodiscard]] Eigen::MatrixXd integral_over(std::size_t k, const Eigen::VectorXd& shift) const {
    const std::vector<LambdaPoint> points = points_of(k);
    double highest = -1e300, sum = 0.0;
    for (const auto& point : points) highest = std::max(highest, point.log_weight());
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(problem_.N.rows(), problem_.N.cols());
    for (const auto& point : points) {
      const double weight = std::exp(point.log_weight() - highest);
      const Eigen::VectorXd moved = point.shift - shift;
      out += weight * (with_excess(point.covariance) + moved * moved.transpose());
      sum += weight;
    }
    return out / sum;
  }

  const NormalEquations problem_;
  const std::vector<Penalty>& penalties_;
  double sigma2_;
  const Eigen::MatrixXd& excess_;
};

/// Priors counted as data, everything in the PenaltyBasis.
NormalEquations turned(const NormalEquations& problem, const Eigen::MatrixXd& Q, double sigma2) {
  NormalEquations out = problem;
  const Eigen::MatrixXd priors = sigma2 * Eigen::MatrixXd(problem.prior.precision.asDiagonal());
  out.N = Q.transpose() * (problem.N + priors) * Q;
  out.g = Q.transpose() * (problem.g + priors * (problem.theta - problem.prior.mean));
  out.theta = Q.transpose() * problem.theta;
  out.prior = ColumnPriors{}.padded(problem.theta.size());
  return out;
}

}  // namespace

Eigen::MatrixXd with_uncertain_roughness(const NormalEquations& problem, const std::vector<Penalty>& penalties, double sigma2,
                                         const Eigen::MatrixXd& excess) {
  const PenaltyBasis basis = penalty_eigenbasis(problem.N.rows(), penalties);
  const Eigen::MatrixXd& Q = basis.Q;
  if (!penalties.empty()) {
    const Eigen::MatrixXd more = excess.size() > 0 ? Eigen::MatrixXd(Q.transpose() * excess * Q) : excess;
    if (const Eigen::MatrixXd out = AlongLambda(turned(problem, Q, sigma2), basis.penalties, sigma2, more).average(); out.size() > 0)
      return Q * out * Q.transpose();
  }
  Eigen::MatrixXd plain;
  if (!invert_with(precision_of(problem, {}, sigma2), basis, plain)) return {};
  if (excess.size() > 0) plain += plain * excess * plain;
  return plain;
}

std::vector<RoughnessPoints> roughness_paths(const NormalEquations& problem, const std::vector<Penalty>& penalties, double sigma2) {
  constexpr int decades = 4, per_decade = 3;
  const PenaltyBasis basis = penalty_eigenbasis(problem.N.rows(), penalties);
  const Eigen::MatrixXd none;
  const AlongLambda along(turned(problem, basis.Q, sigma2), basis.penalties, sigma2, none);
  std::vector<RoughnessPoints> out;
  for (std::size_t k = 0; k < penalties.size(); ++k) {
    const double used = penalties[k].lambda;
    const std::optional<LambdaPoint> here = used > 0.0 ? along.at(k, used) : std::nullopt;
    if (!here) continue;
    RoughnessPoints& points = out.emplace_back();
    points.curve = penalties[k].curve;
    points.used = used;
    points.chosen = penalties[k].chosen;
    for (int i = -decades * per_decade; i <= decades * per_decade; ++i) {
      const double lambda = i == 0 ? used : used * std::pow(10.0, i / static_cast<double>(per_decade));
      const std::optional<LambdaPoint> point = i == 0 ? here : along.at(k, lambda);
      if (!point) continue;
      points.lambda.push_back(lambda);
      points.theta.emplace_back(problem.theta + basis.Q * (point->shift - here->shift));
      points.log_likelihood.push_back(point->log_likelihood - here->log_likelihood);
    }
  }
  return out;
}

}  // namespace misfit
