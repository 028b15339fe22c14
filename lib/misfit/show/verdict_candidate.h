#pragma once

#include <map>
#include <string>

#include "misfit/data/candidates.h"

namespace misfit {

// What a verdict says of one candidate.

/// "missing: lag, with tau = 0.60 ± 0.02 s (p = 1e-09)", or that one of its group is; `still`: beside what was added.
[[nodiscard]] std::string missing_in_words(const Candidate& best, bool still);

/// Of one with Candidate::holds: "between its samples wind is rather constant, where …".
[[nodiscard]] std::string hold_in_words(const Candidate& best);

/// "X can be added by hand, …"; empty where what is held out has spoken against it.
[[nodiscard]] std::string by_hand(const Candidate& rejected);

/// The first candidate, where a lack of fit that it leaves is all that speaks against it; nullptr: it is another.
[[nodiscard]] const Candidate* nearest_of_library(const Discovery& d);

/// " --at 'of=q' --at 'port=dq/dt'"
[[nodiscard]] std::string at_place(const std::map<std::string, std::string>& roles);

}  // namespace misfit
