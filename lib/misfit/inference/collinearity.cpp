#include <algorithm>
#include <cmath>
#include <optional>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/inference/identifiable.h"
#include "misfit/inference/prior.h"
#include "misfit/math/covariance.h"
#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

/// A parameter or a curve's scale: its change is `weights` · changes of the free parameters, its value `value`.
struct Direction {
  std::string name, unit;
  double value = 0.0;
  Eigen::VectorXd weights;
  double sigma = 0.0;
};

std::vector<Direction> directions_of(const Model& model, const Eigen::MatrixXd& covariance) {
  std::vector<Direction> out;
  const std::vector<int> free = model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c) {
    const Parameter& p = model.parameters[free[c]];
    const Eigen::Index at = c;
    if (p.curve >= 0 || !(covariance(at, at) > 0.0)) continue;
    out.push_back({p.name, p.unit, p.value, Eigen::VectorXd::Unit(covariance.rows(), at)});
  }
  for (std::size_t k = 0; k < model.curves.size(); ++k) {
    const Curve& curve = model.curves[k];
    const auto column = std::find(free.begin(), free.end(), curve.first);
    if (column == free.end()) continue;
    const Eigen::Index first = column - free.begin(), size = curve.spline.size();
    Eigen::VectorXd c(size);
    for (Eigen::Index i = 0; i < size; ++i) c[i] = model.parameters[curve.first + i].value;
    Eigen::MatrixXd inverse;
    if (!invert_scaled(covariance.block(first, first, size, size), inverse)) continue;
    const Eigen::VectorXd weighted = inverse * c;
    if (!(weighted.dot(c) > 0.0)) continue;
    Direction scale{"the scale of " + curve.name, "-", 1.0, Eigen::VectorXd::Zero(covariance.rows())};
    scale.weights.segment(first, size) = weighted / weighted.dot(c);
    out.push_back(std::move(scale));
  }
  return out;
}

std::string percent(double share) {
  const double value = 100.0 * share;
  constexpr double smallest_shown = 0.05;
  if (value < smallest_shown) return "better than 0.1 %";
  return format_value(value < 10.0 ? std::round(10.0 * value) / 10.0 : std::round(value)) + " %";
}

/// Its sigma: relative to its value unless it exceeds that.
std::string sigma_text(const Direction& d) {
  return d.sigma < std::abs(d.value) ? percent(d.sigma / std::abs(d.value)) : "± " + in_display_unit(d.sigma, d.unit);
}

/// Two directions and their correlation.
std::string pair_in_words(const Direction& one, const Direction& other, double correlation) {
  const std::string &first = one.name, &second = other.name;
  constexpr double max_ratio = 1.25;
  const bool known = one.sigma < std::abs(one.value) && other.sigma < std::abs(other.value);
  const double a = known ? one.sigma / std::abs(one.value) : 1.0, b = known ? other.sigma / std::abs(other.value) : 1.0;
  const bool equally_uncertain = known && a < max_ratio * b && b < max_ratio * a;
  const double together = std::sqrt(std::max(a * a + b * b - 2.0 * std::abs(correlation) * a * b, 0.0));
  if (equally_uncertain) {
    const std::string kind = correlation > 0.0 ? "ratio" : "product";
    return first + " and " + second + " are nearly collinear: their " + kind + " is known to " + percent(together) +
           ", individually they are known only to " + percent(a) + " and " + percent(b);
  }
  return first + " and " + second + " are correlated (correlation " + format_value(std::round(1000.0 * correlation) / 1000.0) +
         "): separately they are known only to " + sigma_text(one) + " and " + sigma_text(other);
}

std::string group_in_words(const std::vector<std::string>& names) {
  return join_words(names) + " are collinear: a combination of them is known much better than each";
}

void report_collinear(std::vector<Direction> all, const Eigen::MatrixXd& covariance, Fit& fit) {
  const Eigen::Index n = std::ssize(all);
  if (n < 2) return;
  Eigen::MatrixXd weights(n, covariance.rows());
  for (Eigen::Index i = 0; i < n; ++i) weights.row(i) = all[i].weights;
  const Eigen::MatrixXd joint = weights * covariance * weights.transpose();
  const Eigen::VectorXd sigma = joint.diagonal().cwiseSqrt();
  const Eigen::MatrixXd correlation = sigma.cwiseInverse().asDiagonal() * joint * sigma.cwiseInverse().asDiagonal();
  const SymmetricEigen eigen = symmetric_eigen(correlation);
  if (!eigen.converged) return;
  for (Eigen::Index i = 0; i < n; ++i) all[i].sigma = sigma[i];
  constexpr double collinear = 0.02, min_share = 0.25;  // eigenvalue of the correlation matrix; of the largest entry of its vector
  constexpr double min_relative_sigma = 0.05;
  for (Eigen::Index k = 0; k < n && eigen.values[k] < collinear; ++k) {
    const Eigen::VectorXd v = eigen.vectors.col(k);
    std::vector<std::string> names;
    std::vector<double> relative;
    std::vector<Eigen::Index> places;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (std::abs(v[i]) < min_share * v.cwiseAbs().maxCoeff()) continue;
      const Direction& d = all[i];
      names.push_back(d.name);
      relative.push_back(d.sigma / std::max(std::abs(d.value), 1e-300));
      places.push_back(i);
    }
    if (names.size() < 2 || *std::max_element(relative.begin(), relative.end()) < min_relative_sigma) continue;
    if (names.size() > 2) {  // two weak directions of the same parameters give one warning
      const std::string words = group_in_words(names);
      if (std::find(fit.warnings.begin(), fit.warnings.end(), words) == fit.warnings.end()) fit.warnings.push_back(words);
      continue;
    }
    const Direction &one = all[places[0]], &other = all[places[1]];
    const double sign = one.value * other.value < 0.0 ? -1.0 : 1.0;
    fit.warnings.push_back(pair_in_words(one, other, sign * correlation(places[0], places[1])));
  }
}

/// The bound at which a parameter ended, if it did.
std::optional<double> bound_reached(const Parameter& p) {
  constexpr double tolerance = 1e-6;
  for (const double bound : {p.lower, p.upper}) {
    if (std::isfinite(bound) && std::abs(p.value - bound) <= tolerance * p.scale) return bound;
  }
  return std::nullopt;
}

/// Of a time constant of the system that ends at its lower bound: the effect with a memory that does what it did. None where the bound is
/// not next to nothing beside the longest of that effect's own times.
std::optional<std::string> what_replaces_lag(const Model& model, int parameter, double bound) {
  constexpr double next_to_nothing = 0.05;
  const Parameter& p = model.parameters[parameter];
  const auto is_time = [](const Parameter& q) { return q.unit == "s"; };
  if (parameter >= std::ssize(model.system->spec().constants) || !is_time(p) || bound != p.lower) return std::nullopt;
  for (const BoundEffect& effect : model.effects) {
    if (effect.effect->spec().states.empty()) continue;
    for (const BoundCoefficient& c : effect.coefficients) {
      if (c.parameter < 0 || !is_time(model.parameters[c.parameter])) continue;
      if (bound <= next_to_nothing * model.parameters[c.parameter].value) return effect.name;
    }
  }
  return std::nullopt;
}

/// A parameter that ended at a bound, in words; a doubt of what else was estimated unless it is not needed.
void report_bound(const Model& model, int parameter, double bound, Fit& fit) {
  const Parameter& p = model.parameters[parameter];
  const std::string words = p.name + " ends at its bound, " + in_display_unit(bound, p.unit);
  const std::string what_it_means = ": the best value may lie beyond, and its sigma does not describe an interval there";
  if (bound == 0.0) {
    fit.warnings.push_back(words + what_it_means);
  } else if (const auto effect = what_replaces_lag(model, parameter, bound)) {
    fit.warnings.push_back(words + ": " + *effect + " takes the place of this lag");
  } else {
    fit.add_doubt(words, what_it_means);
  }
}

}  // namespace

void warn_of_collinearity(const Model& model, const Eigen::MatrixXd& covariance, Fit& fit) {
  if (covariance.rows() == 0 || !covariance.allFinite()) return;
  report_collinear(directions_of(model, covariance), covariance, fit);
  const std::vector<int> free = model.free_parameters();
  std::string prior_only;
  for (std::size_t c = 0; c < free.size(); ++c) {
    const Parameter& p = model.parameters[free[c]];
    const Eigen::Index at = c;
    if (p.curve >= 0 || !(covariance(at, at) > 0.0)) continue;
    const double sigma = standard_error(covariance, at);
    constexpr double min_share_of_prior = 0.95;
    if (p.prior_sigma && sigma > min_share_of_prior * *p.prior_sigma) {
      prior_only += (prior_only.empty() ? "" : ", ") + p.name;
    } else if (p.kind == CoefficientKind::shape && sigma > std::max(std::abs(p.value), p.lower >= 0.0 ? 0.0 : p.scale)) {
      fit.warnings.push_back(p.name + " is hardly determined by these data: " + in_display_unit(p.value, p.unit, sigma));
    }
    if (const std::optional<double> bound = bound_reached(p)) report_bound(model, free[c], *bound, fit);
  }
  if (!prior_only.empty()) fit.facts["prior_only"] = "these data add no information to the prior of " + prior_only;
}

namespace {

/// "Fix it and …": what keeps a parameter from compensating the scale of a curve.
std::string how_to_hold(const Model& model, int parameter) {
  const std::string& name = model.parameters[parameter].name;
  if (parameter >= std::ssize(model.system->spec().constants)) return "Fix it ([parameters] " + name + " = { free = false })";
  return "Fix it and give its sigma ([geometry] " + name + " = { value, sigma }), so that it is propagated instead of estimated";
}

}  // namespace

void reject_prior_conflicts(const Model& model, const Eigen::MatrixXd& covariance, Fit& fit) {
  constexpr double max_prior_sigmas = 2.0, max_share_of_prior = 0.5;
  const std::vector<Penalty> penalties = curve_penalties(model);
  const bool penalised = std::any_of(penalties.begin(), penalties.end(), [](const Penalty& p) { return p.lambda > 0.0; });
  const std::vector<int> free = model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c) {
    const Parameter& p = model.parameters[free[c]];
    const double sigma = standard_error(covariance, static_cast<Eigen::Index>(c));
    if (p.curve >= 0 || !p.prior_sigma || fit.status != FitStatus::converged) continue;
    if (std::abs(p.value - p.prior_mean) < max_prior_sigmas * *p.prior_sigma || sigma < max_share_of_prior * *p.prior_sigma) continue;
    const std::string here = in_display_unit(p.value, p.unit, sigma), prior = in_display_unit(p.prior_mean, p.unit, *p.prior_sigma);
    if (!penalised) {
      fit.warnings.push_back("these data and the prior of " + p.name + " disagree: it ends at " + here + ", its prior is " + prior);
      continue;
    }
    fit.status = FitStatus::failed;
    fit.message = p.name + " has run to " + here + ", away from its prior " + prior +
                  ": it compensates the scale of a curve, and the roughness penalty is smaller for a smaller curve. " +
                  how_to_hold(model, free[c]);
  }
}

}  // namespace misfit
