#pragma once

#include <vector>

#include "misfit/discover/screen.h"

namespace misfit {

/// Sensor effects that would imitate an accepted physical one if the calibration did not forbid it: how far off they would have to be, as
/// sentences.
void add_likenesses(const std::vector<Screened>& screened, const ScoreTest& score, Discovery& out);

}  // namespace misfit
