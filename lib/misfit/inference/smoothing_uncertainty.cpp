#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "misfit/inference/roughness.h"

namespace misfit {
namespace {

/// The problem's Gaussian at one set of weights.
struct Place {
  Eigen::MatrixXd covariance;
  Eigen::VectorXd moved;  ///< maximum less the problem's θ
  double log_weight = 0.0;
};

class Mixture {
 public:
  Mixture(NormalEquations problem, const std::vector<Penalty>& penalties, double sigma2, const Eigen::MatrixXd& excess)
      : problem_(std::move(problem)), penalties_(penalties), sigma2_(sigma2), excess_(excess) {}

  Eigen::MatrixXd run() {
    const std::optional<Place> best = at(0, penalties_[0].lambda);
    if (!best) return {};
    const Eigen::MatrixXd here = own(*best, false);
    Eigen::MatrixXd out = here;
    for (std::size_t k = 0; k < penalties_.size(); ++k) {
      if (penalties_[k].chosen) out += over(k) - here;
    }
    return out;
  }

 private:
  [[nodiscard]] Eigen::MatrixXd own(const Place& place, bool with_shift) const {
    Eigen::MatrixXd out = place.covariance;
    if (excess_.size() > 0) out += place.covariance * excess_ * place.covariance;
    if (with_shift) out += place.moved * place.moved.transpose();
    return out;
  }

  /// nullopt where the information is not positive definite.
  [[nodiscard]] std::optional<Place> at(std::size_t k, double lambda) const {
    std::vector<Penalty> here = penalties_;
    here[k].lambda = lambda;
    const Eigen::MatrixXd H = precision_of(problem_, here, sigma2_);
    const Eigen::VectorXd scale = H.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * H * scale.asDiagonal());
    if (factor.info() != Eigen::Success) return std::nullopt;
    Place out;
    out.covariance = scale.asDiagonal() * factor.solve(Eigen::MatrixXd::Identity(H.rows(), H.cols())) * scale.asDiagonal();
    if (!out.covariance.allFinite()) return std::nullopt;
    Eigen::VectorXd slope = -problem_.g / sigma2_ - problem_.prior_precision.cwiseProduct(problem_.theta - problem_.prior_mean);
    for (const auto& p : here)
      slope.segment(p.first, p.omega.rows()) -= p.lambda * (p.omega * problem_.theta.segment(p.first, p.omega.rows()));
    out.moved = out.covariance * slope;
    // −2 log density of data and unknowns at the maximum, but for what does not depend on λ_k.
    const double gained = slope.dot(out.moved);
    const Eigen::VectorXd c = problem_.theta.segment(here[k].first, here[k].omega.rows());
    const double cost = lambda * c.dot(here[k].omega * c) - gained;
    const double log_determinant = 2.0 * Eigen::MatrixXd(factor.matrixL()).diagonal().array().log().sum() - 2.0 * scale.array().log().sum();
    out.log_weight = 0.5 * here[k].rank * std::log(lambda) - 0.5 * log_determinant - 0.5 * cost - 0.5 * std::log(lambda);
    return out;
  }

  [[nodiscard]] Eigen::MatrixXd over(std::size_t k) const {
    std::vector<Place> places;
    const double step = std::sqrt(10.0), best = penalties_[k].lambda;
    for (const double factor : {1.0 / step, step}) {
      constexpr int most = 40;
      constexpr double negligible = 10.0;  // of the logarithm
      double highest = -1e300;
      for (int i = factor < 1.0 ? 0 : 1; i < most; ++i) {
        std::optional<Place> place = at(k, best * std::pow(factor, i));
        if (!place) break;
        const double weight = place->log_weight;
        highest = std::max(highest, weight);
        places.push_back(std::move(*place));
        if (weight < highest - negligible) break;
      }
    }
    double highest = -1e300, sum = 0.0;
    for (const auto& place : places) highest = std::max(highest, place.log_weight);
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(problem_.N.rows(), problem_.N.cols());
    for (const auto& place : places) {
      const double weight = std::exp(place.log_weight - highest);
      out += weight * own(place, true);
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
NormalEquations turned(const NormalEquations& problem, const Eigen::MatrixXd& turn, double sigma2) {
  NormalEquations out = problem;
  const Eigen::MatrixXd priors = sigma2 * Eigen::MatrixXd(problem.prior_precision.asDiagonal());
  out.N = turn.transpose() * (problem.N + priors) * turn;
  out.g = turn.transpose() * (problem.g + priors * (problem.theta - problem.prior_mean));
  out.theta = turn.transpose() * problem.theta;
  out.prior_precision.setZero();
  out.prior_mean.setZero();
  return out;
}

}  // namespace

Eigen::MatrixXd with_uncertain_roughness(const NormalEquations& problem, const std::vector<Penalty>& penalties, double sigma2,
                                         const Eigen::MatrixXd& excess) {
  const PenaltyBasis bends = penalty_eigenbasis(problem.N.rows(), penalties);
  const Eigen::MatrixXd& turn = bends.turn;
  if (!penalties.empty()) {
    const Eigen::MatrixXd more = excess.size() > 0 ? Eigen::MatrixXd(turn.transpose() * excess * turn) : excess;
    if (const Eigen::MatrixXd out = Mixture(turned(problem, turn, sigma2), bends.penalties, sigma2, more).run(); out.size() > 0)
      return turn * out * turn.transpose();
  }
  Eigen::MatrixXd plain;
  if (!invert_with(precision_of(problem, {}, sigma2), bends, plain)) return {};
  if (excess.size() > 0) plain += plain * excess * plain;
  return plain;
}

}  // namespace misfit
