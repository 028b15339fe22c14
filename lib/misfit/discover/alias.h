#pragma once

#include <optional>
#include <vector>

#include "misfit/discover/screen.h"

namespace misfit {

/// Sensor effects that would imitate an accepted physical one if the calibration did not forbid it: how far off they would have to be, as
/// sentences.
void report_sensor_aliases(const std::vector<ScreeningResult>& screening, const ScoreTest& score, Discovery& out);

/// Of a candidate's drop: what remains beside it counts only where it is worth more.
inline constexpr double least_share_of_drop = 0.2;

/// An unknown curve or surface of a quantity that the effect reads, significant after it and worth a good part of its drop: then the effect
/// is only a alias of what is missing. `with`: the refitted model that holds it.
[[nodiscard]] std::optional<UnknownCurve> remaining_lack_of_fit(const FilterEstimate& with, const CandidateModel& candidate_model,
                                                                double drop, const DiscoverOptions& options);

}  // namespace misfit
