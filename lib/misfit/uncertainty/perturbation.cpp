#include "misfit/uncertainty/perturbation.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "misfit/core/error.h"
#include "misfit/math/counter_random.h"

namespace misfit {
namespace {

std::uint64_t address_of(std::string_view name) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const unsigned char c : name) hash = (hash ^ c) * 1099511628211ULL;
  return hash;
}

/// L with L Lᵀ = C, also where some variances are 0.
Eigen::MatrixXd root_of(const CorrelatedPerturbation& group) {
  const Eigen::Index n = group.covariance.rows();
  const Eigen::VectorXd sigma = group.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd scale = sigma.unaryExpr([](double s) { return s > 0.0 ? s : 1.0; });
  const Eigen::MatrixXd correlation = scale.cwiseInverse().asDiagonal() * group.covariance * scale.cwiseInverse().asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(correlation);
  constexpr double rounding = 1e-9;
  if (n != group.covariance.cols() || ldlt.info() != Eigen::Success || !(ldlt.vectorD().minCoeff() > -rounding))
    throw InputError((group.source.empty() ? "" : group.source + ": ") + "the covariance of " + group.label + " is invalid: it is not " +
                     "positive semi-definite");
  Eigen::MatrixXd root = ldlt.matrixL();
  root *= ldlt.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  return scale.asDiagonal() * (ldlt.transpositionsP().transpose() * root);
}

}  // namespace

std::vector<std::string> Perturbations::names() const {
  std::vector<std::string> out;
  for (const auto& p : single) out.push_back(p.name);
  for (const auto& g : groups) out.insert(out.end(), g.names.begin(), g.names.end());
  return out;
}

Sampler::Sampler(Perturbations perturbations, unsigned long seed) : perturbations_(std::move(perturbations)), seed_(seed) {
  std::size_t term = 0;
  for (std::size_t i = 0; i < perturbations_.single.size(); ++i) term_of_factor_.push_back(term++);
  for (const auto& group : perturbations_.groups) {
    roots_.push_back(root_of(group));
    term_of_factor_.insert(term_of_factor_.end(), group.names.size(), term++);
  }
}

Draw Sampler::draw(std::size_t run) const {
  Draw out;
  for (const auto& p : perturbations_.single) {
    const std::uint64_t stream = address_of(p.name);
    const double z = p.uniform ? std::sqrt(3.0) * (2.0 * random_uniform(seed_, run, stream) - 1.0) : random_normal(seed_, run, stream);
    out.factors.push_back(z);
    out.errors.push_back(p.sigma * z);
  }
  for (std::size_t g = 0; g < roots_.size(); ++g) {
    const auto& names = perturbations_.groups[g].names;
    Eigen::VectorXd z(std::ssize(names));
    for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = random_normal(seed_, run, address_of(names[i]));
    const Eigen::VectorXd errors = roots_[g] * z;
    out.factors.insert(out.factors.end(), z.begin(), z.end());
    out.errors.insert(out.errors.end(), errors.begin(), errors.end());
  }
  return out;
}

std::vector<std::string> Sampler::term_names() const {
  std::vector<std::string> out;
  for (const auto& p : perturbations_.single) out.push_back(p.name);
  for (const auto& g : perturbations_.groups) out.push_back(g.label);
  return out;
}

bool Sampler::is_uniform(std::size_t factor) const {
  return factor < perturbations_.single.size() && perturbations_.single[factor].uniform;
}

}  // namespace misfit
