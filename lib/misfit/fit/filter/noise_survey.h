#pragma once

#include <vector>

#include "misfit/fit/filter/filter_noise_fit.h"

namespace misfit {

/// Maxima of the noise's likelihood, the runs' trajectories fixed: fit_noise() from correlation times of the random force from 0.2 to 20
/// times the usual one (search.reference), with the coloured noise of `start` and with the usual one; the best of a few iterations each are
/// carried on. The highest first; of those whose correlation times differ by less than a fifth only the highest. Empty: nothing could be
/// run.
[[nodiscard]] std::vector<NoiseFit> noise_maxima(const LinearisedRuns& runs, const FilterNoise& start, const NoiseSearch& search);

}  // namespace misfit
