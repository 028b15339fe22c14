#pragma once

#include <limits>

namespace misfit {

/// What stands for a sample that was not measured, or cannot be computed from what was.
inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

}  // namespace misfit
