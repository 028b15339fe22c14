#pragma once

// References
//   [MI]  R. E. Maine, K. W. Iliff, SIAM J. Appl. Math. 41 (1981): Gauss–Newton on innovations, gains fixed per iteration.

#include <optional>

#include "misfit/fit/filter/filter_noise_fit.h"
#include "misfit/inference/fitted_model.h"

namespace misfit {

struct FilterOptions {
  int threads = 0;                         ///< 0: one per core; does not change the answer
  std::optional<FilterNoise> noise;        ///< where to start; nullopt: looked for
  std::vector<double> noise_factors = {};  ///< where it is looked for: what to multiply the first one with, outputs, then force
  std::optional<FilterNoise> reference;    ///< what sets the bounds of the noise; nullopt: the data
  std::optional<std::vector<std::vector<SampleRole>>> use;  ///< per experiment, so that two models are compared on the same measurements
  std::optional<std::vector<IntegrationPlan>> plans;        ///< per experiment, for the same reason, and kept; nullopt: along the first run
  bool choose_roughness = true;                             ///< false: penalties as handed over
  double integration = kSearchTolerance;                    ///< tolerance of the integration to begin with
  bool verify = true;                                       ///< derivatives of the exact likelihood at the end, and steps by them
  /// Objective that is of use: the steps at the end stop where, by far, they do not promise to come there. nullopt: any.
  std::optional<double> least = {};
  /// Every run of the search goes on to the end of the recordings. Else it ends where the fit does, but for the last one, unless that one
  /// diverges in what is held out.
  bool whole_runs = false;
};

/// Where a search for the maximum begins.
struct FilterStart {
  Model model;
  std::vector<Penalty> penalties;
  std::optional<FilterNoise> noise = {};  ///< nullopt: FilterOptions::noise
  /// Begin with hardly any random force, as output error does, and with what noise that leaves. Beside another start.
  bool freely = false;
};

/// The maximum of the penalised likelihood with everything that diagnosis and discovery need of it.
struct FilterEstimate {
  Model model;         ///< the caller's, with the estimates
  FilterModel forced;  ///< the same with the random force
  std::vector<Penalty> penalties;
  FilterNoise noise, reference;
  NoiseFit noise_fit;
  std::vector<FilterData> data;
  std::vector<FilterTrace> traces;
  std::vector<FilterJacobian> jacobians;  ///< at the estimate
  Eigen::MatrixXd covariance;             ///< of the free parameters: inverse of the information with roughness and priors
  Eigen::MatrixXd joint_covariance;       ///< of parameters and log noise together, nothing fixed; empty where not verified
  Eigen::MatrixXd joint_information;      ///< of which that is the inverse, without the roughness
  double objective = 0.0;                 ///< log-likelihood + log priors of parameters, roughness and noise
  double loglik = 0.0, validation_loglik = 0.0;
  std::optional<double> newton_decrement;  ///< what one more Newton step on the exact likelihood would still gain; nullopt: not verified
  double edf = 0.0;
  bool converged = false;
  bool out_of_time = false;  ///< a limit of time was spent (core/watch.h): the best point until then
  bool whole_runs = false;   ///< FilterOptions::whole_runs
  std::string message;
  std::vector<std::string> notes;  ///< on where the search began, and what it found besides
  std::string integration;         ///< what it costs and what its error does to the estimates, in words; empty where not verified
  int outliers = 0;
  std::vector<double> nonlinear;  ///< times [s] of measurements that move the filter but do not count: its linearisation breaks there
  int linearisations = 0;

  /// Of the objective.
  [[nodiscard]] GaussianPrior prior() const { return {parameter_priors(model), penalties}; }
  /// Of steps and covariances.
  [[nodiscard]] GaussianPrior regularised_prior(const Eigen::VectorXd& information) const {
    return {regularised_priors(model, information), penalties};
  }
};

/// Innovations that count, of all experiments: rows of the Jacobians.
[[nodiscard]] inline Eigen::Index counted_rows(const FilterEstimate& estimate) {
  Eigen::Index rows = 0;
  for (const auto& jacobian : estimate.jacobians) rows += jacobian.r.size();
  return rows;
}

/// The steps of integration that it was found with, per experiment.
[[nodiscard]] std::vector<IntegrationPlan> plans_of(const FilterEstimate& estimate);

/// Maximum likelihood of parameters, roughness and noise (lib/misfit/README.md, 5.7, which has the steps with their numbers): noise raised
/// until the model can be run; its noise searched for; parameters by Gauss–Newton on innovations with the gains fixed per iteration [MI],
/// roughness by marginal likelihood and noise by Fisher scoring, in turn; the correlation time surveyed; outliers set aside; Newton steps
/// over parameters and noise together by the exact likelihood; the integration refined; covariance.
/// Penalties: those of `start`. RunError if the states cannot be read from the channels or the model can be run from no start.
/// A start that is given noise, uses and roughness is also a floor: the search does not end below it. Where a limit of time is spent
/// (core/watch.h), the best point so far, not converged (`out_of_time`); TimeLimitReached if there is none.
[[nodiscard]] FilterEstimate estimate_filter(const Model& start, std::vector<Penalty> penalties, const std::vector<Signals>& experiments,
                                             const FilterOptions& options = {});

/// The same from several starts of one model: a few rounds of the blocks in turn from each, then on from the best, and from a second one
/// that is not clearly lower; of these the end with the higher marginal likelihood (marginal_loglik()).
[[nodiscard]] FilterEstimate estimate_filter(const std::vector<FilterStart>& starts, const std::vector<Signals>& experiments,
                                             const FilterOptions& options = {});

/// The free parameters fitted by a free run with hardly any random force, its initial states estimated, as output error does: Gauss–Newton
/// steps from those of `start`, the white noise as large as what is left, until that falls by less than 1 %. Without covariance. RunError:
/// the model cannot be run so.
[[nodiscard]] FilterEstimate estimate_freely(const Model& start, std::vector<Penalty> penalties, const std::vector<Signals>& experiments,
                                             const FilterOptions& options);

/// Has a free run of the model, its initial states estimated, residuals of less than half of the variance of every output?
[[nodiscard]] bool follows_freely(const Model& model, const std::vector<Signals>& experiments);

}  // namespace misfit
