#pragma once

#include <string>
#include <vector>

#include "misfit/data/comparison.h"
#include "misfit/data/diagnosis.h"
#include "misfit/data/fit.h"
#include "misfit/data/ladder.h"

namespace misfit {

/// The fit that the verdict is about: of the method with a random force where that was used, else the last one that has residuals. nullptr:
/// there is none.
[[nodiscard]] const Fit* leading_fit(const std::vector<Fit>& fits);

/// Why no test of an effect says anything of this fit: measurements so few that no parameter has a standard error, or predictions one
/// sample ahead that are no better than the mean of the motion. Empty: it is neither.
[[nodiscard]] std::string why_nothing_is_known(const Fit& fit);

/// That the fitted model does not make the statistics of the measured motion, though no effect is found missing; empty: it does, or they
/// were not compared (nullptr: not at all).
[[nodiscard]] std::string motion_in_doubt(const Comparison* comparison);

/// That a map of a model's missing force is significant at 1 %, though no effect is found missing; empty: none is, or none was made
/// (nullptr).
[[nodiscard]] std::string map_in_doubt(const Diagnosis* diagnosis);

/// Parameters of the study's own model that it knew, to a third at least, and of which the last model knows nothing any more: sigma above
/// the value, then and now. What was added does what they did: "T_tau is no longer determined beside what was added: (2.1 ± 6.2)e6 s".
[[nodiscard]] std::vector<std::string> no_longer_determined(const Rung& first, const Rung& last);

}  // namespace misfit
