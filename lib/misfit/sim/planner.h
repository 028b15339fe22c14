#pragma once

#include "misfit/sim/trajectory.h"

namespace misfit {

/// [share of a state's range] for the search of a fit, which judges what is left by what it does to the estimates; and for a run whose
/// numbers are to stand by themselves.
inline constexpr double kSearchTolerance = 1e-4, kRunTolerance = 1e-10;

/// Divides every interval of an experiment so that one step over each part has an error below `tolerance` × the range of every state over
/// `states` (samples × states, the reference; a row that is not finite: the motion runs on). Error: the difference of a step and its two
/// halves, over 15 (order four). Explicit steps need (fastest rate) × part ≤ 0.5 as well; where an interval would be divided into more than
/// 100 parts, and a part is longer than 3 / (fastest rate of the linearised equations), it is stepped by Radau IIA. No part is more than
/// twice as long as its neighbours within and beside a divided interval: what is fast may happen a little earlier or later when parameters
/// move.
[[nodiscard]] IntegrationPlan plan_along(const Simulation& simulation, const RowMatrix& states, double tolerance);

/// The same along the model's own motion from x0, with the largest size of every state so far for its range, and without allowing for other
/// parameters.
[[nodiscard]] IntegrationPlan plan_run(const Simulation& simulation, const double* x0, double tolerance = kRunTolerance);

/// Parts of a single interval for the motion from x, errors measured by the states' present sizes.
[[nodiscard]] std::vector<StepPart> plan_interval(Stepper& stepper, const Interval& interval, const double* x, double tolerance);

}  // namespace misfit
