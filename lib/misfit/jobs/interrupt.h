#pragma once

#include <atomic>
#include <optional>
#include <utility>

#include "misfit/jobs/ranks.h"

namespace misfit {

/// True asks long work to stop: it finishes what it is at, writes, and ends. Whoever wants to stop it sets it: a signal handler may (it is
/// lock-free), as may another thread.
[[nodiscard]] std::atomic<bool>& interrupted();

/// RunError "interrupted; …" if interrupted() is true: called between stages, when everything done so far is on disk.
void stop_if_interrupted();

/// The result of work shared by all ranks, which is missing after an interrupt: RunError as stop_if_interrupted() or, where only another
/// rank was interrupted, EndedElsewhere.
template <class Result>
[[nodiscard]] Result finished(std::optional<Result> result) {
  if (result) return std::move(*result);
  stop_if_interrupted();
  throw EndedElsewhere();
}

}  // namespace misfit
