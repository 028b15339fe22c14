#pragma once

#include "misfit/discover/unknown_curves.h"

namespace misfit {

/// Screening result of an effect as a candidate among `families`: score, p-value, strengths after one Gauss–Newton step, and the shapes of
/// its best cell (without sigma), where a refit would start.
[[nodiscard]] Candidate named_candidate(const ScreeningResult& screening, double families);

/// "vortex_shedding (physics): 8 cells, 700 effective tests, 0.2 to 12 Hz", and above which frequency it was not looked for where that is
/// so.
[[nodiscard]] std::string what_was_tried(const ScreeningResult& screening);

/// The same of an unknown curve.
[[nodiscard]] Candidate unknown_candidate(const UnknownCurve& curve, double families, double p_accept);

/// Ranks from 1 for candidates that come by significance: what was accepted first (an unknown curve can always imitate it), then what was
/// refitted.
void rank_candidates(std::vector<Candidate>& candidates);

}  // namespace misfit
