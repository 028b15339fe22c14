#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "misfit/jobs/job_queue.h"

namespace misfit {

/// What one run gives, of a Monte-Carlo or of a bootstrap.
struct ChainResult {
  std::vector<double> numbers;  ///< always the same ones in the same order, NaN where this run has none; empty: the run failed …
  std::string failure;          ///< … for this reason
};

/// As bytes, to the last bit, and back. RunError if they are none of these.
[[nodiscard]] std::string pack(const ChainResult& result);
[[nodiscard]] ChainResult unpack_result(std::string_view bytes);

/// Runs 0 … jobs.count − 1 over threads and ranks, each on disk at once (run_stored_jobs()), in their order; nullopt if it was stopped; on
/// ranks other than the first none.
[[nodiscard]] std::optional<std::vector<ChainResult>> stored_runs(const std::function<ChainResult(std::size_t k)>& run,
                                                                  const StoredJobs& jobs, const ProgressFn& progress = {},
                                                                  const std::atomic<bool>* stop = nullptr);

/// Counts a failed run under its reason; beyond twenty reasons the others are counted together.
void count_failure(const std::string& reason, std::map<std::string, std::size_t>& failures);
/// The reason of the most; the map must not be empty.
[[nodiscard]] const std::string& most_frequent(const std::map<std::string, std::size_t>& failures);

}  // namespace misfit
