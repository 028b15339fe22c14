#pragma once

#include <string>

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// Shortest period of the motion [s]: 2π/ω with ω² = Σ x'²/Σ (x − mean)² of a state along the filtered motion, the fastest of the system's
/// states that channels show; a state that hardly moves beside its typical size has none. Infinity if there is none.
[[nodiscard]] double shortest_period(const FilterEstimate& estimate);

/// A random force that keeps its value for longer than the motion's shortest period is hardly random beside it: what changes as slowly and
/// is no larger (an offset, dry friction, drag) may be attributed to it, and the model's own parameters for such effects come out too small
/// with intervals that do not know it. Says so, with time, period and strength; empty where the force is shorter, 0 or given as white.
[[nodiscard]] std::string warning_of_slow_force(const FilterEstimate& estimate);

}  // namespace misfit
