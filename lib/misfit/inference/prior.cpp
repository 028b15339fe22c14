#include "misfit/inference/prior.h"

#include <algorithm>
#include <cmath>

#include "misfit/math/decompositions.h"

namespace misfit {
ColumnPriors parameter_priors(const Model& model) {
  const std::vector<int> free = model.free_parameters();
  ColumnPriors out{Eigen::VectorXd::Zero(std::ssize(free)), Eigen::VectorXd::Zero(std::ssize(free))};
  for (Eigen::Index c = 0; c < std::ssize(free); ++c) {
    const Parameter& p = model.parameters[free[c]];
    if (!p.prior_sigma) continue;
    out.precision[c] = 1.0 / (*p.prior_sigma * *p.prior_sigma);
    out.mean[c] = p.prior_mean;
  }
  return out;
}

ColumnPriors regularised_priors(const Model& model, const Eigen::VectorXd& information) {
  constexpr double very_wide = 1e3, said_nothing = 1e9;  // typical sizes
  constexpr double notable = 1e-2, share = 1e-6;         // of the data's information
  const std::vector<int> free = model.free_parameters();
  ColumnPriors out = parameter_priors(model);
  for (Eigen::Index c = 0; c < std::ssize(free); ++c) {
    const Parameter& p = model.parameters[free[c]];
    if (p.prior_sigma) continue;
    out.precision[c] = 1.0 / std::pow(very_wide * p.scale, 2);
    const bool known = information[c] > 1.0 / std::pow(said_nothing * p.scale, 2);
    if (p.curve < 0 && known && out.precision[c] > notable * information[c]) out.precision[c] = share * information[c];
  }
  return out;
}

std::vector<int> left_to_wide_priors(const Model& model, const Eigen::VectorXd& information, const Eigen::MatrixXd& covariance) {
  constexpr double mostly = 0.5;
  const std::vector<int> free = model.free_parameters();
  const ColumnPriors wide = regularised_priors(model, information);
  std::vector<int> out;
  for (Eigen::Index c = 0; c < std::min(std::ssize(free), covariance.rows()); ++c) {
    const Parameter& p = model.parameters[free[c]];
    if (!p.prior_sigma && p.curve < 0 && covariance(c, c) * wide.precision[c] > mostly) out.push_back(free[c]);
  }
  return out;
}

double log_prior(const Parameter& parameter) {
  return parameter.prior_sigma ? -0.5 * std::pow((parameter.value - parameter.prior_mean) / *parameter.prior_sigma, 2) : 0.0;
}

double ColumnPriors::log_density(const Eigen::VectorXd& theta) const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < precision.size(); ++i) sum -= 0.5 * precision[i] * std::pow(theta[i] - mean[i], 2);
  return sum;
}

Eigen::VectorXd ColumnPriors::gradient(const Eigen::VectorXd& theta) const { return precision.cwiseProduct(mean - theta); }

ColumnPriors ColumnPriors::padded(Eigen::Index unknowns) const {
  ColumnPriors out{Eigen::VectorXd::Zero(unknowns), Eigen::VectorXd::Zero(unknowns)};
  out.precision.head(precision.size()) = precision;
  out.mean.head(mean.size()) = mean;
  return out;
}

double Penalty::log_normalisation() const { return 0.5 * rank * std::log(lambda); }

double GaussianPrior::log_density(const Eigen::VectorXd& theta) const {
  double sum = columns.log_density(theta);
  for (const Penalty& p : penalties) {
    const auto c = theta.segment(p.first, p.omega.rows());
    sum -= 0.5 * p.lambda * c.dot(p.omega * c);
  }
  return sum;
}

Eigen::VectorXd GaussianPrior::gradient(const Eigen::VectorXd& theta) const {
  Eigen::VectorXd out = columns.gradient(theta);
  for (const Penalty& p : penalties) {
    const Eigen::Index size = p.omega.rows();
    out.segment(p.first, size) -= p.lambda * (p.omega * theta.segment(p.first, size));
  }
  return out;
}

void GaussianPrior::add_precision(Eigen::MatrixXd& information) const {
  information.diagonal() += columns.precision;
  for (const Penalty& p : penalties) information.block(p.first, p.first, p.omega.rows(), p.omega.cols()) += p.lambda * p.omega;
}

ColumnPriors regularised_priors_about(const Eigen::VectorXd& at, const Model& model, const std::vector<Penalty>& penalties,
                                      const Eigen::MatrixXd& information) {
  constexpr double mostly = 0.5;
  const Eigen::VectorXd stated = parameter_priors(model).precision;
  ColumnPriors out = regularised_priors(model, information.diagonal());
  if (stated.size() == 0) return out;
  const Eigen::VectorXd wide = (stated.array() > 0.0).select(0.0, out.precision);
  Eigen::MatrixXd all = information.topLeftCorner(stated.size(), stated.size());
  GaussianPrior{out, penalties}.add_precision(all);
  const Eigen::VectorXd scale = all.diagonal().cwiseSqrt();  // all = scale C scale; sqrt(C) scale theta has unit variances
  const Eigen::VectorXd inverse = scale.cwiseInverse();
  const SymmetricEigen correlation = symmetric_eigen(inverse.asDiagonal() * all * inverse.asDiagonal());
  if (!(correlation.values.minCoeff() > 0.0)) return out;
  const Eigen::VectorXd roots = correlation.values.cwiseSqrt();
  const Eigen::MatrixXd root = correlation.with(roots), inverse_root = correlation.with(roots.cwiseInverse());
  const Eigen::VectorXd share = wide.cwiseProduct(inverse.cwiseAbs2());
  const SymmetricEigen known = symmetric_eigen(inverse_root * share.asDiagonal() * inverse_root);
  const Eigen::VectorXd kept = (known.values.array() < mostly).cast<double>();
  const Eigen::VectorXd rotated = known.vectors.transpose() * (root * scale.cwiseProduct(at));
  const Eigen::VectorXd about = (inverse_root * (known.vectors * kept.cwiseProduct(rotated))).cwiseProduct(inverse);
  out.mean = (stated.array() > 0.0).select(out.mean, about);
  return out;
}

double log_prior(const Model& model, const std::vector<Penalty>& penalties) {
  return GaussianPrior{parameter_priors(model), penalties}.log_density(model.theta());
}

std::vector<Penalty> curve_penalties(const Model& model) {
  std::vector<Penalty> penalties;
  const std::vector<int> free = model.free_parameters();
  for (int k = 0; k < std::ssize(model.curves); ++k) {
    const Curve& curve = model.curves[k];
    const auto column = std::find(free.begin(), free.end(), curve.first);
    if (column == free.end()) continue;
    Penalty p;
    p.curve = k;
    p.first = static_cast<int>(column - free.begin());
    p.omega = curve.spline.roughness();
    p.rank = curve.spline.size() - 2;
    p.chosen = !curve.roughness.has_value();
    const double range = curve.spline.highest() - curve.spline.lowest();
    constexpr double curvature_factor = 10.0;  // start loose: more structure than a parabola of typical size
    p.lambda = curve.roughness.value_or(std::pow(range, 3) / std::pow(curvature_factor * curve.scale, 2));
    penalties.push_back(std::move(p));
  }
  return penalties;
}

Model with_roughness(Model model, const std::vector<Penalty>& penalties) {
  for (const Penalty& p : penalties) model.curves[p.curve].roughness = p.lambda;
  return model;
}

std::vector<PriorRows> prior_rows(const GaussianPrior& prior) {
  std::vector<PriorRows> out;
  for (const Penalty& p : prior.penalties) {
    const SymmetricEigen eigen = symmetric_eigen(p.omega);
    const Eigen::VectorXd values = (p.lambda * eigen.values.cwiseMax(0.0)).cwiseSqrt();
    out.push_back({p.first, values.asDiagonal() * eigen.vectors.transpose(), Eigen::VectorXd::Zero(p.omega.rows())});
  }
  for (int c = 0; c < prior.columns.precision.size(); ++c) {
    const double precision = prior.columns.precision[c];
    if (precision > 0.0) out.push_back({c, Eigen::MatrixXd::Constant(1, 1, std::sqrt(precision)), prior.columns.mean.segment(c, 1)});
  }
  return out;
}

bool any_chosen(const std::vector<Penalty>& penalties) {
  return std::any_of(penalties.begin(), penalties.end(), [](const Penalty& p) { return p.chosen; });
}

std::vector<Penalty> with_fixed_weights(std::vector<Penalty> penalties) {
  for (Penalty& p : penalties) p.chosen = false;
  return penalties;
}

}  // namespace misfit
