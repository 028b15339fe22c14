#pragma once

#include <optional>
#include <vector>

#include "misfit/discover/refit.h"

namespace misfit {

/// A library effect in the ranking of a search, best first.
struct RankedCandidate {
  const ScreeningResult* screening = nullptr;
  Candidate candidate;
  std::optional<Refit> refit;
  double log_p = 0.0;  ///< of the refit where there is one
};

/// What a search works on, for testing again in another model.
struct SearchContext {
  const FilterEstimate& estimate;
  const Registry& registry;
  const std::vector<Signals>& experiments;
  const DiscoverOptions& options;
  double families = 1.0;  ///< that a p-value is corrected for
};

/// Step by step: lib/misfit/README.md, 6.5. Accepts at most one of those that hold out: significant, with strengths away from their bounds,
/// at a maximum that was reached, and the held-out measurements more likely. Of these the first, in the order of the list, after which no
/// unknown curve remains of a quantity that it or an alias before it reads (remaining_lack_of_fit): an effect that leaves one is an alias
/// of what is missing, be its drop the largest. If all leave something, the first with which a second known effect leaves nothing, as long
/// as each is still needed beside the other and no strength of the two ends at a bound. It comes to the front and is grouped with every
/// other whose refitted drop is near (6): inseparable if both can be in the model and neither has a significant score once the other is in.
/// Where nothing is accepted the group is that of the front. All that were refitted get a reason. Returned: what remains, unexplained,
/// where that is why nothing was accepted.
[[nodiscard]] std::optional<UnknownCurve> accept_best(std::vector<RankedCandidate>& ranked, const SearchContext& context);

}  // namespace misfit
