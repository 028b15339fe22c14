#pragma once

#include <optional>
#include <vector>

#include "misfit/discover/screen.h"

namespace misfit {

/// Sensor effects that would imitate an accepted physical one if the calibration did not forbid it: how far off they would have to be, as
/// sentences.
void add_likenesses(const std::vector<Screened>& screened, const ScoreTest& score, Discovery& out);

/// An unknown curve of a quantity that the effect reads, significant after it and worth a good part of its drop: then the effect is only a
/// likeness of what is missing. `with`: the refitted model that holds it.
[[nodiscard]] std::optional<UnknownCurve> what_is_left(const FilterEstimate& with, const Specimen& specimen, double drop,
                                                       const DiscoverOptions& options);

}  // namespace misfit
