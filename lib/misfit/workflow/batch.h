#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/batch.h"
#include "misfit/workflow/session/session.h"

namespace misfit {

struct FittedBatch {
  Batch batch;
  std::filesystem::path folder;  ///< of batch.json, batch.csv, figures/ and studies/NAME/
};

/// Fits many studies as one job, each with one thread in a run folder of its own, on threads or ranks. `studies`: lists, folders, studies
/// (batch_list.h); `options`: those of every study; its `out` is the folder of the batch. A study that fails is a row that says why. Empty
/// on ranks other than the first.
[[nodiscard]] std::optional<FittedBatch> fit_batch(const SessionOptions& options, const std::vector<std::string>& studies,
                                                   const Registry& registry);

}  // namespace misfit
