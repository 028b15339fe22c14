#pragma once

#include "misfit/fit/filter/filter_run.h"

namespace misfit {

/// Noise as it usually is on such data, before anything is fitted: white noise from fifth differences of the channels, coloured noise as
/// large at 0.15 of the sampling rate or three times the motion's own frequency, a force of 0.3 of the measured accelerations (or rates)
/// with a correlation time of six samples. Where it acts on states that no channel shows alone: 0.3 of the rates that the model itself
/// gives them, or of the one that takes them through their typical size in the recording. Of several recordings: the force of the one that
/// moves most; the rest of the first, which stands for all.
[[nodiscard]] FilterNoise usual_noise(const FilterModel& model, const std::vector<FilterData>& data);

/// Marks in the usual noise what the study knows: noise and correlation time that are given, the prior of the force's strength. RunError if
/// the random force acts on no port of the prior's unit.
void mark_known(const FilterModel& model, FilterNoise& usual);

/// Marks in the usual noise the rounding of channels that are read in whole steps: no reading says more than its step (B. Widrow, I.
/// Kollar, Quantization Noise (2008), ch. 4), and where most readings repeat the one before, a random force that follows the stairs would
/// have densities without bound. Not of a channel whose readings the model takes for intervals: its noise comes before the rounding.
void mark_rounding(const FilterModel& model, const std::vector<FilterData>& data, FilterNoise& usual);

}  // namespace misfit
