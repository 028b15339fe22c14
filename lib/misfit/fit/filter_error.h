#pragma once

#include "misfit/fit/filter_estimate.h"

namespace misfit {

/// The filter's estimate as a fit: parameters, curves with bands, trim, noise, force, one-step predictions with sigma, log-likelihoods, and
/// what a reader must know (outliers, gaps, whether the motion is driven at all, what the exact derivatives said).
[[nodiscard]] Fit filter_fit(const FilterEstimate& estimate);

/// RMS of predictions 1, 2, 4, … steps ahead (kLadderSteps) per channel over the counted samples, in SI: the filtered state run on without
/// further readings.
[[nodiscard]] std::map<std::string, std::vector<double>> k_step_errors(const FilterEstimate& estimate, bool validation = false);

/// Estimate and fit in one: DESIGN 5. Status `declined` in words where the states cannot be read or too little data are left.
struct FilterError {
  Fit fit;
  std::optional<FilterEstimate> estimate;
};
[[nodiscard]] FilterError filter_error(const FittedModel& start, const std::vector<Signals>& experiments,
                                       const FilterOptions& options = {});

}  // namespace misfit
