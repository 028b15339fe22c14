#pragma once

#include "misfit/fit/filter/filter_run.h"

namespace misfit {

/// Where the outputs read the size of a state alone (a sensor that loses the sign), the first sample says nothing of its sign: each
/// experiment begins with the state, and its rate with it, as the channels show it or with the other sign, whichever the later measurements
/// go better with: by the log-likelihood of a run with these parameters and hardly any random force, which follows the sign that it begins
/// with. A state is such a one if turning it changes no output at the first sample by more than 1e-6 of the state. Left as it is where the
/// model cannot be run so.
void choose_mirrored_starts(const FilterModel& model, const std::vector<double>& values, const FilterNoise& noise,
                            std::vector<FilterData>& data);

}  // namespace misfit
