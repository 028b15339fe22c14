#pragma once

#include <vector>

#include "misfit/data/candidates.h"
#include "misfit/data/ladder.h"

namespace misfit {

/// Those of the round that were refitted and explain more than half of what the accepted one does: the first three.
[[nodiscard]] std::vector<Candidate> alternatives_to(const Candidate& accepted, const Discovery& discovery);

/// Where its refit ended, other effects were in the model.
[[nodiscard]] Candidate without_refit(Candidate candidate);

/// Of a rung whose effect has one estimated number: that this is not known, its sigma being larger than itself, whatever the drop says (a
/// clock that is off by 1.0 ± 4.3 s: the likelihood has a kink there). Empty: it is known, or there are more, or none.
[[nodiscard]] std::string why_undetermined(const Rung& rung);

/// Knots with one more in the middle of each interval. Empty: there would be too many to be fitted.
[[nodiscard]] std::vector<double> twice_as_many(const std::vector<double>& knots);

}  // namespace misfit
