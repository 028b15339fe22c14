#pragma once

#include <string>

#include "misfit/data/fit.h"
#include "misfit/data/signals.h"
#include "misfit/inference/roughness.h"
#include "misfit/model/model.h"

namespace misfit {

/// The free parameters that nothing informs, as a sentence; empty if there is none. `information`: diagonal of the normal matrix of the
/// residuals and the stated priors, free parameters first.
[[nodiscard]] std::string without_effect(const Model& model, const Eigen::VectorXd& information);

/// Which free parameters these data do not determine, as a sentence: a parameter that no residual depends on, or several of which only a
/// combination acts — named as product or ratio where it is one. From the eigenvectors of the normal matrix N with the priors (scaled to
/// unit diagonal; curves, held by their roughness, are left out; further columns of N, initial states, are projected out) with
/// eigenvalues below 1e-10 of the largest. Residuals of `problem` in units of their sigma. Empty if every parameter is determined.
[[nodiscard]] std::string undetermined(const Model& model, const NormalEquations& problem);

/// Which initial states these data do not determine, as a sentence: those in the eigenvectors of `precision` (of the free parameters, then
/// of the states of each experiment; scaled to unit diagonal, priors and roughness included) with such eigenvalues. Empty if there is none.
[[nodiscard]] std::string undetermined_starts(const Model& model, const Eigen::MatrixXd& precision,
                                              const std::vector<Signals>& experiments);

/// The same as undetermined() where `problem` carries the very wide priors of regularised_priors(): only those that the model states count.
/// `sigma2`: the variance of one of its residuals.
[[nodiscard]] std::string undetermined_beside_priors(const Model& model, NormalEquations problem, double sigma2);

/// Weakly determined directions, as warnings: parameters, and curves as a whole (their scale), that compensate each other — smallest
/// eigenvalues below 0.02 of their correlation matrix (a pair: |correlation| above 0.98) where one of them is known to no better than 5 % —
/// with how well their ratio or product is known and how well they themselves are; shapes known to no better than 100 % (those of either
/// sign: than their typical size); and parameters that end at a bound. A curve's scale: its coefficients all times 1 + s, estimated with
/// the least variance. Into facts, as "prior_only": parameters to whose prior the data add no information (sigma above 0.95 of the
/// prior's). `covariance`: of the free parameters.
void warn_of_collinearity(const Model& model, const Eigen::MatrixXd& covariance, Fit& fit);

/// A converged fit in which a parameter ends more than two of its prior's sigmas from the prior's mean, while its own sigma is above half
/// of the prior's: data that agree with the prior move a parameter so far only if they determine it better than the prior does. In a model
/// with a free curve that has a roughness it is marked as failed, with the reason: the penalty is smaller for smaller curves, where a
/// parameter compensates the scale of a curve. In another one prior and data disagree, as a warning.
void reject_prior_conflicts(const Model& model, const Eigen::MatrixXd& covariance, Fit& fit);

}  // namespace misfit
