#pragma once

#include "tests/benchmark/hidden_table.h"
#include "tests/benchmark/hidden_worlds.h"

namespace misfit::bench {

/// Fits the model that lacks what is hidden, asks discovery, and refits with the true effect from the truth for the oracle's drop. `known`:
/// what discovery may name; `truth`: with the effects under hidden_effects/.
[[nodiscard]] Row answer(const World& world, double seconds, const Registry& known, const Registry& truth, int threads);

}  // namespace misfit::bench
