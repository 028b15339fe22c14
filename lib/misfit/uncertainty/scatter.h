#pragma once

#include <vector>

#include "misfit/data/batch.h"

namespace misfit {

/// Mean, scatter and test of every number that at least two studies of a batch have by the same method (BatchSummary). The test takes the
/// studies' errors as independent; it is left out where a sigma is not known. Order: methods and numbers as they first appear.
[[nodiscard]] std::vector<BatchSummary> summarise(const std::vector<BatchRow>& rows);

}  // namespace misfit
