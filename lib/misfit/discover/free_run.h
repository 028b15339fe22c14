#pragma once

#include <optional>
#include <vector>

#include "misfit/discover/screen.h"

namespace misfit {

/// An estimate seen over the other horizon: parameters as they are, the random force off, so that the filter is a free run whose initial
/// states alone are estimated, and white measurement noise as large as what that leaves. One step ahead a force that changes slowly (the
/// sun on a house, a leak, drag) can hardly be distinguished from the random force, which takes it over; the free run shows all of it.
/// Residuals are correlated here, so that likelihoods mean nothing: only shares of what is left do. nullopt: the random force does little,
/// the free run's residuals being usually less than 1.2 times those of one step in every output, or the model cannot be run so.
[[nodiscard]] std::optional<FilterEstimate> free_run(const FilterEstimate& estimate);

/// Of candidates screened at the free run the three forces that explain most of it, each at least a fifth; the largest first.
[[nodiscard]] std::vector<const ScreeningResult*> forces_shown_by(const FilterEstimate& calm, const std::vector<ScreeningResult>& screened);

/// Whether of the squares of a free run a fifth is gone in another: geometric mean over the outputs.
[[nodiscard]] bool is_explained(const FilterEstimate& calm, const FilterEstimate& after);

}  // namespace misfit
