#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/discover/refit.h"
#include "misfit/jobs/job_queue.h"

namespace misfit {

/// One effect refitted from where one step leads, and the drop of that step.
struct SteppedRefit {
  double predicted_drop = 0.0;
  Refit refit;
};

/// Where the results are kept, and how the work is watched.
struct RefitJobs {
  std::optional<StoredJobs> stored = std::nullopt;
  ProgressFn progress = {};
  const std::atomic<bool>* stop = nullptr;
};

/// A job each, in the order of `effects`; the answer does not depend on threads and ranks.
///
/// With `stored` (its `count` follows from the effects) each is on disk when it ends and the ranks share them (run_stored_jobs()): a search
/// begun again goes on. nullopt if `stop` became true before all were done.
[[nodiscard]] std::optional<std::vector<SteppedRefit>> refit_all(const RefitWork& work, const ScoreTest& score,
                                                                 const std::vector<const ScreeningResult*>& effects,
                                                                 const RefitJobs& jobs = {});

/// To the last bit, and back beside what it was made of. RunError: the bytes are of another refit.
[[nodiscard]] std::string pack(const SteppedRefit& result, const ScreeningResult& effect);
[[nodiscard]] SteppedRefit unpack_refit(std::string_view bytes, const RefitWork& work, const ScreeningResult& effect);

}  // namespace misfit
