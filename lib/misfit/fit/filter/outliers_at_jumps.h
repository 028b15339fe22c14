#pragma once

#include <string>

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// Of rejected measurements that come where a held input jumps, ": 10 of them within two samples of a jump of I, as 4 % of all are …": no
/// wild ones, but an input or a sensor whose time is off, or a feedthrough that the model lacks. Empty where less than half of them do, or
/// no more than by chance, or where measurements are excluded for another reason.
[[nodiscard]] std::string outliers_at_jumps(const FilterEstimate& estimate);

}  // namespace misfit
