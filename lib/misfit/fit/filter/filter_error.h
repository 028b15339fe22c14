#pragma once

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// The filter's estimate as a fit: parameters, curves with bands, trim, noise, force, one-step predictions with sigma, log-likelihoods, and
/// what a reader must know (outliers, gaps, whether the motion is driven at all, what the exact derivatives said).
[[nodiscard]] Fit filter_fit(const FilterEstimate& estimate, int threads = 1);

/// Estimate and fit in one (lib/misfit/README.md, 5.6). Status `declined` in words where the states cannot be read or too little data are
/// left.
struct FilterErrorFit {
  Fit fit;
  std::optional<FilterEstimate> estimate;
};
[[nodiscard]] FilterErrorFit filter_error(const FittedModel& start, const std::vector<Signals>& experiments,
                                          const FilterOptions& options = {});
/// The same from several starts of one model.
[[nodiscard]] FilterErrorFit filter_error(const std::vector<FilterStart>& starts, const std::vector<Signals>& experiments,
                                          const FilterOptions& options = {});

}  // namespace misfit
