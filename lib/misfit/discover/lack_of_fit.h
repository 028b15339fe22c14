#pragma once

#include <optional>
#include <vector>

#include "misfit/discover/unknown_curves.h"

namespace misfit {

/// Sensor effects that would imitate an accepted physical one if the calibration did not forbid it: how far off they would have to be, as
/// sentences.
void report_sensor_imitations(const std::vector<ScreeningResult>& screening, const ScoreTest& score, Discovery& out);

/// What remains beside a candidate counts where it is worth more than this share of its drop: something else that is missing may remain.
inline constexpr double least_share_of_drop = 0.2;
/// The same beside two that are to explain all between them, and of another form of a candidate's own memory, which nothing else leaves.
inline constexpr double least_share_of_all = 0.05;

/// What a refitted model holds beyond the first one: its drop, and what something that remains must be worth to count.
struct Added {
  double drop = 0.0, least_share = least_share_of_drop;
  int effects = 1;
};

/// An unknown curve or surface of a quantity that the effect reads, an error of an output that depends on one (not where the outputs are
/// those of a calibrated camera), or another form of its memory: significant after it and worth enough. Then the effect is
/// only an imitation of what is missing. `with`: the refitted model that holds it.
[[nodiscard]] std::optional<UnknownCurve> remaining_lack_of_fit(const FilterEstimate& with, const CandidateModel& candidate_model,
                                                                const Added& added, const DiscoverOptions& options);

/// Of curves of the first screening, the most significant of which more than half is left in the refitted model: whatever its effect is, it
/// is not that. A true effect leaves nothing of the curves that it shows in.
[[nodiscard]] std::optional<UnknownCurve> mostly_left(const FilterEstimate& with, std::vector<UnknownCurve> screened,
                                                      const DiscoverOptions& options);

}  // namespace misfit
