#pragma once

#include <string>
#include <vector>

#include "misfit/data/comparison.h"
#include "misfit/data/fit.h"
#include "misfit/data/reference.h"

namespace misfit {

/// Methods side by side, their curves against each other and against reference curves, their trims against each other and the references'.
/// Like with like only: the same curve name, quantity and units; where both visited it (count > 0). What is left out is in `not_compared`
/// with why: fits that declined or failed, curves marked not informative, ranges that do not meet, curves without any uncertainty.
[[nodiscard]] Comparison compare(const std::vector<Fit>& fits, const std::vector<Reference>& references);

}  // namespace misfit
