#pragma once

#include <vector>

#include "misfit/data/diagnosis.h"

namespace misfit {

/// Forces that are missing in pulses only: a door that is opened, a valve that sticks, an impact. Of each port, the stretches in which the
/// smoothed random force, in units of what the model expects of it there, lies more than eight robust standard deviations (mad_sigma())
/// from its median, those less than three samples apart taken together. They are pulses where there are three of them or more, together
/// they last less than a fifth of the recording, and hold three quarters of the sum of squares about the median: a normal or an
/// autocorrelated force has none so large, and one that depends on a state or an input is there for longer. In words, with their number,
/// length, direction, size and times, and the input at whose changes most of them begin, if there is one.
[[nodiscard]] std::vector<ForcePulses> pulses_of(const std::vector<MissingForce>& missing);

}  // namespace misfit
