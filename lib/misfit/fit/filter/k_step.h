#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// Errors of free runs from the filter's states, by length.
struct KStepErrors {
  std::map<std::string, std::vector<double>> rms;  ///< per channel at 1, 2, 4, … samples (kLadderSteps), in SI; NaN: none, or too few runs
  std::vector<std::size_t> runs, diverged;         ///< per length: that the recording is long enough for, and of these the failed ones
  std::string words;                               ///< on the runs that diverge; empty: none does
};

/// Which measurements predictions are compared with.
enum class ComparedSamples : std::uint8_t { counted, held_out, both };

/// RMS of predictions 1, 2, 4, … samples ahead per channel over the compared samples: the filtered state run on without further
/// measurements, from where it is settled (settled.h), and known well enough for that many samples: the sigma of what is predicted is at
/// most three times the usual one. A run that diverges has no error to count. Where more than 3 % do, what is left says
/// how good the good ones are: no RMS is given.
[[nodiscard]] KStepErrors k_step_errors(const FilterEstimate& estimate, ComparedSamples compared = ComparedSamples::counted);

/// Predictions of one experiment kFarAhead samples ahead, [output][sample] in SI: the filtered state run on without further measurements.
/// NaN: none reaches there (at the beginning, behind gaps, where the run diverges, and between those of a recording of more than 1000
/// samples, of which every second, third, … is predicted).
[[nodiscard]] std::vector<std::vector<double>> predictions_far_ahead(const FilterEstimate& estimate, std::size_t experiment);

/// How the errors of the longest predictions that both models have changed: RMS over the channels of (after/before). Infinite where those
/// after diverge and those before do not; 1 where nothing can be compared.
[[nodiscard]] double growth_of_errors(const std::map<std::string, std::vector<double>>& before,
                                      const std::map<std::string, std::vector<double>>& after);

/// A model that is nearer to the truth predicts better one sample ahead and farther ahead. One that imitates what is missing over one
/// sample, or of which the data determine too little, loses the motion sooner than the model without it: its errors grow by more than this.
inline constexpr double kMostGrowthOfErrors = 1.2;
/// "predictions farther ahead get worse: their RMS errors grow by 85 %".
[[nodiscard]] std::string growth_in_words(double growth);

}  // namespace misfit
