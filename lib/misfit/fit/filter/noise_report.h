#pragma once

#include <map>
#include <string>

#include "misfit/data/fit.h"
#include "misfit/fit/filter/filter_estimate.h"

// What a filter_error fit says of noise and random force.
namespace misfit {

/// Strength of the random force on each port; sigma 0: not determined.
[[nodiscard]] std::map<std::string, Estimate> estimated_force(const FilterEstimate& estimate);

/// Noise of the outputs and random force with their sigmas; of the first force's strength and the correlation time with 95 % intervals.
/// Sets whether the motion is driven.
void add_noise(const FilterEstimate& estimate, int threads, Fit& fit);

/// After add_noise(). The bounds of pack() keep a search away from where nothing is determined: an estimate there is none, and a warning
/// says so; not of frequency and damping of a coloured noise that is hardly more likely than white noise alone.
void warn_of_noise_at_bounds(const FilterEstimate& estimate, int threads, Fit& fit);

}  // namespace misfit
