#pragma once

#include <string>

#include "misfit/data/reference.h"
#include "misfit/report/figure.h"

namespace misfit::report {

/// Points of somebody else's curve with bars of one sigma.
[[nodiscard]] Series reference_series(const Reference& reference, const std::string& legend);

}  // namespace misfit::report
