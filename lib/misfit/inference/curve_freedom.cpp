#include "misfit/inference/curve_freedom.h"

#include <fmt/format.h>

#include <Eigen/Dense>

#include "misfit/data/curve_coefficient.h"

namespace misfit {

std::vector<double> curve_freedom(const NormalEquations& problem, const std::vector<Penalty>& penalties, double sigma2) {
  const Eigen::MatrixXd known = precision_of(problem, {}, sigma2);
  Eigen::MatrixXd covariance;
  if (!invert_with(known, penalty_eigenbasis(known.rows(), penalties), covariance)) return {};
  const Eigen::VectorXd freedom = (covariance * known).diagonal();
  std::vector<double> out;
  for (const Penalty& p : penalties) out.push_back(freedom.segment(p.first, p.omega.rows()).sum());
  return out;
}

void describe_freedom(const Model& model, const NormalEquations& problem, const std::vector<Penalty>& penalties, double sigma2, Fit& fit) {
  const std::vector<double> freedom = curve_freedom(problem, penalties, sigma2);
  for (std::size_t k = 0; k < freedom.size(); ++k)
    fit.facts[freedom_fact(model.curves[penalties[k].curve].name)] = fmt::format("{:.1f}", freedom[k]);
}

}  // namespace misfit
