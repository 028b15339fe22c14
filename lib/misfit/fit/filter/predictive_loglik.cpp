#include "misfit/fit/filter/predictive_loglik.h"

#include <Eigen/LU>
#include <cmath>

#include "misfit/fit/filter/likelihood_drop.h"

namespace misfit {

double predictive_loglik(const FilterEstimate& estimate, const std::vector<double>& steps) {
  const Eigen::Index n = estimate.covariance.rows();
  FilterRunner runner(estimate.forced, true);
  runner.set_parameters(estimate.forced.model.values());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(n);
  double loglik = 0.0;
  FilterTrace trace;
  FilterJacobian jacobian;
  for (const FilterData& known : estimate.data) {
    FilterData data = known;
    for (SampleRole& role : data.use) {
      if (role == SampleRole::counted) role = SampleRole::update;
      if (role == SampleRole::validation) role = SampleRole::counted;
    }
    if (!runner.run(data, estimate.noise, trace, {&jacobian}) || jacobian.J.cols() != n) return estimate.validation_loglik;
    loglik += trace.loglik + change_in_cells(data, trace, steps);
    information += jacobian.J.transpose() * jacobian.J;
    slope += jacobian.J.transpose() * jacobian.r;
  }
  if (n == 0) return loglik;
  const Eigen::MatrixXd spread = Eigen::MatrixXd::Identity(n, n) + estimate.covariance * information;
  const Eigen::PartialPivLU<Eigen::MatrixXd> solver(spread);
  const double determinant = solver.determinant(), explained = slope.dot(solver.solve(estimate.covariance * slope));
  if (!(determinant > 0.0) || !std::isfinite(explained)) return loglik;
  return loglik + 0.5 * explained - 0.5 * std::log(determinant);
}

}  // namespace misfit
