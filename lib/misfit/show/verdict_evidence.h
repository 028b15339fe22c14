#pragma once

#include <optional>
#include <string>

#include "misfit/data/ladder.h"

namespace misfit {

/// What the likelihood says of what a rung added. Of the hold: it is late by half a sampling interval, which is the hold of an input and
/// nothing that is missing. A part: something remained beside it, and still does at the end of the ladder, so that it may only look like
/// what is missing. Untested: no likelihood compares it with the model before (another system, or a comparison that was cut off).
enum class Evidence { needed, of_the_hold, a_part, predicts_worse, chance, untested };

[[nodiscard]] Evidence evidence_for(const Rung& rung, bool something_remains);

/// Candidate::also, Rung::also.
[[nodiscard]] bool is_of_the_hold(const std::optional<std::string>& also);

}  // namespace misfit
