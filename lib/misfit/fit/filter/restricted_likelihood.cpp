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
  forced.model.parameters[static_cast<std::size_t>(forced.time_parameter)].value = noise.force_time;
  const std::vector<int> free = estimate.model.free_parameters();
  std::vector<double> all = forced.model.values();
  for (std::size_t c = 0; c < free.size(); ++c) all[static_cast<std::size_t>(free[c])] = theta[static_cast<Eigen::Index>(c)];
  FilterRunner runner(forced, true);
  runner.set_parameters(all);
  NormalEquations sums;
  sums.N = Eigen::MatrixXd::Zero(theta.size(), theta.size());
  sums.theta = theta;
  FilterTrace trace;
  FilterJacobian jacobian;
  for (const FilterData& data : estimate.data) {
    if (!runner.run(data, noise, trace, &jacobian)) return std::nullopt;
    sums.N.selfadjointView<Eigen::Lower>().rankUpdate(jacobian.J.transpose());
  }
  sums.N = Eigen::MatrixXd(sums.N.selfadjointView<Eigen::Lower>());
  set_priors(estimate.model, sums);
  return precision_of(sums, estimate.penalties, 1.0);
}

}  // namespace

RestrictedLikelihood restricted_likelihood(const FilterEstimate& estimate, const Eigen::VectorXd& theta, int threads) {
  const std::vector<double>& logs = estimate.noise_fit.logs;
  const auto q = static_cast<Eigen::Index>(logs.size());
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
    beside[i] = information_with(estimate, theta, unpack(there));
  });
  const std::optional<Eigen::MatrixXd>& here = beside.back();
  Eigen::MatrixXd covariance;
  if (!here || !invert_scaled(*here, covariance)) return out;
  std::vector<Eigen::MatrixXd> share(logs.size());  // N⁻¹ ∂N/∂φ
  for (std::size_t i = 0; i < logs.size(); ++i) {
    if (!beside[i]) continue;
    share[i] = covariance * (*beside[i] - *here) / h;
    out.slope[static_cast<Eigen::Index>(i)] = -0.5 * share[i].trace();
    for (std::size_t j = 0; j <= i; ++j) {
      if (share[j].size() == 0) continue;
      const double lost = 0.5 * share[i].cwiseProduct(share[j].transpose()).sum();
      out.lost(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = lost;
      out.lost(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) = lost;
    }
  }
  return out;
}

}  // namespace misfit
