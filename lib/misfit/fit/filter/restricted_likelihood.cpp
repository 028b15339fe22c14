#include "misfit/fit/filter/restricted_likelihood.h"

#include <Eigen/Dense>
#include <cmath>
#include <optional>

#include "misfit/jobs/work_queue.h"

namespace misfit {
namespace {

/// The parameters' information with roughness and priors under another noise, the filter run anew with it; nullopt: it cannot be run.
std::optional<Eigen::MatrixXd> information_with(const FilterEstimate& estimate, const Eigen::VectorXd& theta, const FilterNoise& noise) {
  FilterModel forced = estimate.forced;
  forced.set_force_time(noise.force_time);
  FilterRunner runner(forced, true);
  runner.set_parameters(forced.model.values_at(theta));
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(theta.size(), theta.size());
  FilterTrace trace;
  FilterJacobian jacobian;
  for (const FilterData& data : estimate.data) {
    if (!runner.run(data, noise, trace, {.jacobian = &jacobian, .held_out = estimate.whole_runs})) return std::nullopt;
    jacobian.add_information(information);
  }
  information = Eigen::MatrixXd(information.selfadjointView<Eigen::Lower>());
  estimate.regularised_prior(information.diagonal()).add_precision(information);
  return information;
}

}  // namespace

RestrictedLikelihood restricted_likelihood(const FilterEstimate& estimate, const Eigen::VectorXd& theta, int threads) {
  const std::vector<double>& logs = estimate.noise_fit.logs;
  const Eigen::Index q = logs.size();
  RestrictedLikelihood out{Eigen::VectorXd::Zero(q), Eigen::MatrixXd::Zero(q, q)};
  if (theta.size() == 0) return out;
  constexpr double h = 1e-3;
  std::vector<std::optional<Eigen::MatrixXd>> beside(logs.size() + 1);
  run_jobs(beside.size(), threads, [&](std::size_t i) {
    std::vector<double> there = logs;
    if (i < logs.size()) {
      if (estimate.noise_fit.at_bound[i]) return;
      there[i] += h;
    }
    beside[i] = information_with(estimate, theta, unpack(there, estimate.model.system->spec()));
  });
  const std::optional<Eigen::MatrixXd>& here = beside.back();
  Eigen::MatrixXd covariance;
  if (!here || !invert_scaled(*here, covariance)) return out;
  std::vector<Eigen::MatrixXd> share(logs.size());  // N⁻¹ ∂N/∂φ
  for (std::size_t i = 0; i < logs.size(); ++i) {
    if (!beside[i]) continue;
    share[i] = covariance * (*beside[i] - *here) / h;
    out.slope[i] = -0.5 * share[i].trace();
    for (std::size_t j = 0; j <= i; ++j) {
      if (share[j].size() == 0) continue;
      const double loss = 0.5 * share[i].cwiseProduct(share[j].transpose()).sum();
      out.information_loss(i, j) = loss;
      out.information_loss(j, i) = loss;
    }
  }
  return out;
}

}  // namespace misfit
