#pragma once

#include <vector>

#include "misfit/discover/ranked.h"
#include "misfit/discover/screen.h"

namespace misfit {

/// Beside a curve of unknown form (EffectSpec::has_unknown_form()) that is in the model: candidates that the free parameters and that curve
/// would describe if its knots were closer together are not tested (Candidate::absorbed). A curve with its knots too far apart leaves
/// something at a kink, and an offset or a scale of the sensor of its quantity, which only moves the kink to where a knot is, seems to be
/// significant then; beside a curve that may be any it could not even be told from none. Described: 1 - R² below 0.01 of each of its
/// columns on those of the free parameters and of hats of the curve's quantity at the curve's place, 24 and 72 of them.
void leave_out_what_a_finer_curve_describes(const ScoreWork& work, std::vector<RankedCandidate>& ranked);

}  // namespace misfit
