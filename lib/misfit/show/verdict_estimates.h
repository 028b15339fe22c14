#pragma once

#include <map>
#include <string>
#include <vector>

#include "misfit/data/ladder.h"

namespace misfit {

// What a verdict says of estimates.

using Estimates = std::map<std::string, Estimate>;

/// "R = 0.870 ± 0.012 V/A, L = …" without coefficients of curves; of very many the first, and how many more there are. Empty: there is
/// none.
[[nodiscard]] std::string numbers_of(const Estimates& parameters);

/// "quadratic_drag: drag = 0.5010 ± 0.0004 1/m": of what was added, as the last model has it; where that differs, also as its own rung has
/// it. Then the other parameters of the last model.
[[nodiscard]] std::vector<std::string> added_with_estimates(const Ladder& ladder);

}  // namespace misfit
