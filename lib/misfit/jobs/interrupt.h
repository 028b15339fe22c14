#pragma once

#include <optional>
#include <utility>

#include "misfit/core/watch.h"
#include "misfit/jobs/ranks.h"

namespace misfit {

/// Interrupted if interrupted() is true: called between stages, when everything done so far is on disk.
void stop_if_interrupted();

/// The result of work shared by all ranks, which is missing after an interrupt: Interrupted or, where only another rank was interrupted,
/// EndedElsewhere.
template <class Result>
[[nodiscard]] Result finished(std::optional<Result> result) {
  if (result) return std::move(*result);
  stop_if_interrupted();
  throw EndedElsewhere();
}

}  // namespace misfit
