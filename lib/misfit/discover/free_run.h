#pragma once

#include <optional>
#include <vector>

#include "misfit/discover/screen.h"

namespace misfit {

struct FreeRunWork {
  const std::vector<Signals>& experiments;
  int threads = 0;  ///< does not change the answer
};

/// An estimate seen over the other horizon: the random force off, so that the filter is a free run whose initial states are estimated, and
/// white measurement noise as large as what that leaves. One step ahead a force that changes slowly (the sun on a house, a leak, drag) can
/// hardly be distinguished from the random force, which takes it over; the free run shows all of it. The parameters are those that the free
/// run fits best from the estimate on (estimate_freely()), since a slow random force may have moved them to where they explain nothing;
/// those of the estimate where that ends no better. Residuals are correlated here, so that likelihoods mean nothing: only shares of what is
/// left do. nullopt: the random force does little, the free run's residuals being usually less than 1.2 times those of one step in every
/// output, or the model cannot be run so.
[[nodiscard]] std::optional<FilterEstimate> free_run(const FilterEstimate& estimate, const FreeRunWork& work);

/// Of candidates screened at the free run the three forces that explain most of it, each at least a fifth, and the best at each further
/// port (another state lacks something of its own), six at most; the largest first.
[[nodiscard]] std::vector<const ScreeningResult*> forces_shown_by(const FilterEstimate& calm, const std::vector<ScreeningResult>& screened);

/// Whether of the squares of a free run a fifth is gone in another: geometric mean over the outputs.
[[nodiscard]] bool is_explained(const FilterEstimate& calm, const FilterEstimate& after);

}  // namespace misfit
