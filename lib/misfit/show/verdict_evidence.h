#pragma once

#include <string>

#include "misfit/data/comparison.h"
#include "misfit/data/fit.h"

namespace misfit {

/// Why no test of an effect says anything of this fit: measurements so few that no parameter has a standard error, or predictions one
/// sample ahead that are no better than the mean of the motion. Empty: it is neither.
[[nodiscard]] std::string why_nothing_is_known(const Fit& fit);

/// That the fitted model does not make the statistics of the measured motion, though no effect is found missing; empty: it does, or they
/// were not compared (nullptr: not at all).
[[nodiscard]] std::string motion_in_doubt(const Comparison* comparison);

}  // namespace misfit
