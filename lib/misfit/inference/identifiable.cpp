#include "misfit/inference/identifiable.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "misfit/core/text.h"
#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

constexpr double singular_eigenvalue = 1e-10;  // relative to the largest; rounding of the sums leaves about 1e-14

struct Column {
  const Parameter* parameter;
  Eigen::Index at;
};

/// Free parameters that belong to no curve.
std::vector<Column> columns_of(const Model& model) {
  const std::vector<int> free = model.free_parameters();
  std::vector<Column> out;
  for (std::size_t c = 0; c < free.size(); ++c) {
    if (model.parameters[free[c]].curve < 0) out.push_back({&model.parameters[free[c]], static_cast<Eigen::Index>(c)});
  }
  return out;
}

/// Diagonal of the normal matrix with the priors.
Eigen::VectorXd information_of(const NormalEquations& problem) {
  Eigen::VectorXd out = problem.N.diagonal();
  const Eigen::Index priors = std::min(out.size(), problem.prior.precision.size());
  out.head(priors) += problem.prior.precision.head(priors);
  return out;
}

/// Schur complement of the initial states in N with the priors, scaled to unit diagonal, for these columns. `scale`: 1/√information.
Eigen::MatrixXd reduced(const NormalEquations& problem, const Eigen::VectorXd& scale, const std::vector<Column>& columns,
                        Eigen::Index free) {
  const auto n = std::ssize(columns);
  const Eigen::Index states = problem.N.rows() - free;
  Eigen::MatrixXd all = problem.N;
  all.diagonal() = information_of(problem);
  all = scale.asDiagonal() * all * scale.asDiagonal();
  Eigen::MatrixXd N(n, n);
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < n; ++b) N(a, b) = all(columns[a].at, columns[b].at);
  }
  if (states == 0) return N;
  Eigen::MatrixXd C(n, states);
  for (Eigen::Index a = 0; a < n; ++a) C.row(a) = all.row(columns[a].at).tail(states);
  return N - C * minimum_norm_solve(all.bottomRightCorner(states, states), C.transpose());
}

/// "a and b: only their product acts", from the relative changes of them that leave all residuals unchanged.
std::string in_words(const std::vector<std::string>& names, const std::vector<double>& relative) {
  std::string out = "these data do not determine " + join_words(names) + " separately: ";
  constexpr double tolerance = 0.02;
  const bool pair = names.size() == 2 && std::isfinite(relative[0]) && std::isfinite(relative[1]) && relative[0] != 0.0;
  const double ratio = pair ? relative[1] / relative[0] : 0.0;
  if (std::abs(ratio + 1.0) < tolerance) {
    out += "only their product acts";
  } else if (std::abs(ratio - 1.0) < tolerance) {
    out += "only their ratio acts";
  } else {
    out += "a change of one can be compensated by the others";
  }
  return out + "; fix one of them, or give it a prior with sigma";
}

}  // namespace

std::string without_effect(const Model& model, const Eigen::VectorXd& information) {
  std::vector<std::string> idle;
  for (const Column& column : columns_of(model)) {
    if (!(information[column.at] > 0.0)) idle.push_back(column.parameter->name);
  }
  if (idle.empty()) return {};
  return "nothing in these data depends on " + join_words(idle) +
         (idle.size() > 1 ? "; fix them, or remove them" : "; fix it, or remove it") + " from the model";
}

std::string undetermined(const Model& model, const NormalEquations& problem) {
  const Eigen::VectorXd information = information_of(problem);
  if (std::string idle = without_effect(model, information); !idle.empty()) return idle;
  const std::vector<Column> columns = columns_of(model);
  if (columns.size() < 2) return {};
  const Eigen::VectorXd scale = information.cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd N = reduced(problem, scale, columns, model.free_parameters().size());
  const SymmetricEigen eigen = symmetric_eigen(N);
  if (!eigen.converged || eigen.values[0] > singular_eigenvalue * eigen.values.maxCoeff()) return {};
  const Eigen::VectorXd direction = eigen.vectors.col(0);
  constexpr double min_share = 0.1;
  std::vector<std::string> names;
  std::vector<double> relative;
  for (Eigen::Index a = 0; a < direction.size(); ++a) {
    if (std::abs(direction[a]) < min_share * direction.cwiseAbs().maxCoeff()) continue;
    const Parameter& p = *columns[a].parameter;
    names.push_back(p.name);
    relative.push_back(direction[a] * scale[columns[a].at] / p.value);
  }
  return in_words(names, relative);
}

std::string undetermined_starts(const Model& model, const Eigen::MatrixXd& precision, const std::vector<Signals>& experiments) {
  constexpr double least_share = 0.01;  // of the unit length of an eigenvector, squared
  const Eigen::Index columns = std::ssize(model.free_parameters()), n = model.states();
  const Eigen::VectorXd scale = precision.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const SymmetricEigen eigen = symmetric_eigen(scale.asDiagonal() * precision * scale.asDiagonal());
  if (!eigen.converged) return {};
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(precision.rows());
  for (Eigen::Index k = 0; k < shares.size(); ++k) {
    if (eigen.values[k] <= singular_eigenvalue * eigen.values.maxCoeff()) shares += eigen.vectors.col(k).cwiseAbs2();
  }
  std::vector<std::string> names;
  bool of_effects = true;
  for (Eigen::Index at = columns; at < shares.size(); ++at) {
    if (shares[at] < least_share) continue;
    const std::size_t e = (at - columns) / n, j = (at - columns) % n, own = model.state_specs.size();
    names.push_back((j < own ? model.state_specs[j].name : model.own_state_names[j - own]) + " in '" + experiments[e].name + "'");
    of_effects = of_effects && j >= own;
  }
  if (names.empty()) return {};
  return "these data do not determine the initial value of " + join_words(names) +
         (of_effects ? "; leave out the effect that remembers it" : "; give it in [initial], fixed");
}

std::string undetermined_beside_priors(const Model& model, NormalEquations problem, double sigma2) {
  problem.N /= sigma2;
  problem.prior = parameter_priors(model);
  return undetermined(model, problem);
}

}  // namespace misfit
