#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace misfit {

/// Called after each finished job with (done, total), from one thread at a time.
using ProgressFn = std::function<void(std::size_t done, std::size_t total)>;

/// Runs `job(k)` for k = 0 … jobs−1 on `threads` threads (0: one per core). Each job writes only to its own slot k of whatever it fills, so
/// the answer does not depend on the number of threads. The first exception (lowest k among those that ran) stops the rest and is rethrown.
/// Returns false if `stop` became true before all jobs were done; a job that then ends in Interrupted counts as not begun. Jobs are watched
/// by the watch of the caller (core/watch.h).
bool run_jobs(std::size_t jobs, int threads, const std::function<void(std::size_t k)>& job, const ProgressFn& progress = {},
              const std::atomic<bool>* stop = nullptr);

}  // namespace misfit
