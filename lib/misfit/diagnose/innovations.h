#pragma once

// References
//   [LB] G. M. Ljung, G. E. P. Box, Biometrika 65 (1978).
//   [F]  R. A. Fisher, Proc. R. Soc. A 125 (1929): the largest line of a periodogram.
//   [B]  M. S. Bartlett (1955), J. Durbin, Biometrika 56 (1969): cumulative periodogram.

#include "misfit/data/diagnosis.h"
#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// Autocorrelation with its band, Ljung–Box over 40 lags [LB], the highest line with Fisher's g [F] and the cumulative periodogram [B] of
/// standardised innovations at their times: those of one channel that count, so that a lag is one of its own usual steps. The periodogram
/// is that of the innovations closed up over gaps; the highest line is sought in time, with 0 in the gaps.
[[nodiscard]] WhitenessReport whiteness_of(const std::vector<double>& t, const std::vector<double>& innovations);
/// The same of each channel that has at least 100 of them.
[[nodiscard]] std::vector<WhitenessReport> whiteness_of(const FilterEstimate& estimate);

/// Normalised innovation squared per measurement, averaged over windows of about 1/80 of the measurements, at least 20 a channel; nothing
/// of an experiment with fewer.
[[nodiscard]] std::vector<NisSeries> nis_of(const FilterEstimate& estimate);

/// The random force from all measurements, earlier and later, with every quantity at the same samples.
[[nodiscard]] std::vector<MissingForce> missing_force_of(const FilterEstimate& estimate);

}  // namespace misfit
