#pragma once

// References
//   [MI]  R. E. Maine, K. W. Iliff, SIAM J. Appl. Math. 41 (1981): Gauss–Newton on innovations, gains held per iteration.

#include <optional>

#include "misfit/fit/filter/filter_noise_fit.h"
#include "misfit/inference/fitted_model.h"

namespace misfit {

struct FilterOptions {
  int threads = 0;                                          ///< 0: one per core; does not change the answer
  std::optional<FilterNoise> noise;                         ///< where to start; nullopt: looked for
  std::optional<FilterNoise> around;                        ///< what sets the bounds of the noise; nullopt: the data
  std::optional<std::vector<std::vector<SampleRole>>> use;  ///< per experiment, so that two models are compared on the same measurements
  bool choose_roughness = true;                             ///< false: penalties as handed over
  double integration = kSearchTolerance;                    ///< tolerance of the integration to begin with
  bool verify = true;                                       ///< derivatives of the exact likelihood at the end, and steps by them
};

/// The maximum of the penalised likelihood with everything that diagnosis and discovery need of it.
struct FilterEstimate {
  Model model;         ///< the caller's, with the estimates
  FilterModel forced;  ///< the same with the random force
  std::vector<Penalty> penalties;
  FilterNoise noise, around;
  NoiseFit noise_fit;
  std::vector<FilterData> data;
  std::vector<FilterTrace> traces;
  std::vector<FilterJacobian> jacobians;  ///< at the estimate
  Eigen::MatrixXd covariance;             ///< of the free parameters: inverse of the information with roughness and priors
  Eigen::MatrixXd joint_covariance;       ///< of parameters and log noise together, nothing held; empty where not verified
  Eigen::MatrixXd joint_information;      ///< of which that is the inverse, without the roughness
  double objective = 0.0;                 ///< log-likelihood − ½ Σ λ cᵀΩc − ½ Σ ((θ − mean)/prior sigma)²
  double loglik = 0.0, validation_loglik = 0.0;
  std::optional<double> left;  ///< what one more Newton step on the exact likelihood would still gain; nullopt: not verified
  double edf = 0.0;
  bool converged = false;
  std::string message;
  std::string integration;  ///< what it costs and what its error does to the estimates, in words; empty where not verified
  int outliers = 0;
  std::vector<double> nonlinear;  ///< times [s] of measurements that move the filter but do not count: its linearisation breaks there
  int linearisations = 0;
};

/// Maximum likelihood by blocks: physical parameters by Gauss–Newton on innovations with the gains held per iteration [MI], roughness by
/// marginal likelihood, noise by Fisher scoring about the runs. Then, if verified, joint steps by exact derivatives of the whole likelihood
/// (lib/misfit/README.md, 5.7), with the noise by restricted likelihood (filter_restricted.h) and the curvature corrected by what the steps
/// before have shown (learned_curvature.h). Penalties: those of `start`. RunError if the states cannot be read from the channels or the
/// model cannot be run from its start.
[[nodiscard]] FilterEstimate estimate_filter(const Model& start, std::vector<Penalty> penalties, const std::vector<Signals>& experiments,
                                             const FilterOptions& options = {});

/// log prior of the free parameters at their present values, roughness included (constants left out): −½ Σ λ cᵀΩc − ½ Σ ….
[[nodiscard]] double log_prior(const Model& model, const std::vector<Penalty>& penalties);

}  // namespace misfit
