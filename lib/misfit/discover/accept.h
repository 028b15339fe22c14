#pragma once

#include <optional>
#include <vector>

#include "misfit/discover/refit.h"

namespace misfit {

/// A named effect on its way through a search, best first in its list.
struct Entry {
  const Screened* screened = nullptr;
  Candidate candidate;
  std::optional<Refit> refit;
  double log_p = 0.0;  ///< of the refit where there is one
};

/// What was searched, for asking again.
struct Searched {
  const FilterEstimate& estimate;
  const Registry& registry;
  const std::vector<Signals>& experiments;
  const DiscoverOptions& options;
};

/// Groups the best with every other whose refitted drop is near (6, DESIGN 6): inseparable if neither has a significant score once the
/// other is in.
void find_groups(std::vector<Entry>& entries, const Searched& searched);

/// Accepts at most one: the first that is significant, makes the held-out readings more likely with strengths away from their bounds, and
/// after which no dependence on a quantity that it reads remains, or none once a second known effect is in as well. It comes to the
/// front; the others get their words. Returned: what remains, unexplained, where that is why nothing was accepted.
[[nodiscard]] std::optional<UnknownCurve> accept_best(std::vector<Entry>& entries, const Searched& searched);

}  // namespace misfit
