#pragma once

#include <vector>

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// Log predictive density of the held-out measurements, the parameters being uncertain by their covariance C: to first order, with the
/// whitened residuals r and their derivatives J there,
///   log L_held-out(estimate) + bᵀ (C⁻¹ + JᵀJ)⁻¹ b/2 − log det(1 + C JᵀJ)/2,   b = Jᵀ r.
/// With the estimates as if they were exact, an effect that leaves the random force nothing to do would be refused wherever the held-out
/// motion goes beyond what the estimation has seen: the random force makes up for errors of parameters, too. (Gelman et al., Bayesian Data
/// Analysis, 7.1: predictive density.) `steps`: of outputs that another model reads in whole steps, to be compared with that
/// (likelihood_drop.h).
[[nodiscard]] double predictive_loglik(const FilterEstimate& estimate, const std::vector<double>& steps = {});

}  // namespace misfit
