#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "misfit/jobs/checkpoint.h"
#include "misfit/jobs/work_queue.h"

namespace misfit {

/// Jobs 0 … count−1 whose results survive the process.
struct StoredJobs {
  std::filesystem::path folder;  ///< of the checkpoints, made if it is not there; on a disk that all ranks see
  std::string digest;            ///< one word: hash of all that a result depends on but its number; others' results are not taken
  std::size_t count = 0;         ///< may grow from one run to the next: what is there is kept
  int threads = 0;               ///< of this process; 0: one per core, or this rank's share of them
};

/// Results on disk, by number of the job. Holds 16 bytes per job; a result is read when it is asked for.
class JobResults {
 public:
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  /// RunError if the checkpoint has changed since.
  [[nodiscard]] std::string result(std::size_t job) const;

 private:
  struct Place {
    std::uint64_t offset = 0;
    std::uint32_t size = 0;
    std::int32_t file = -1;  ///< −1: not done
  };
  friend JobResults stored_results(const StoredJobs& jobs);
  std::vector<std::filesystem::path> files_;
  std::vector<Place> places_;
};

/// One queue for long computations. Job k runs on rank k mod n (jobs/ranks.h), there on the next free thread; when it ends its
/// bytes are appended to this rank's own FOLDER/checkpoint_RANK.bin. What an earlier run left there, with whatever number of ranks and
/// threads, is kept; a record torn by a sudden end is dropped and its job done again. Since a job must depend on nothing but its number
/// (its random numbers too), the results are the same to the bit however often, and on however many threads and ranks, the work was done.
///
/// Returns the results when all jobs of all ranks are done; nullopt if `stop` became true before. Throws what a job throws (lowest number
/// first), RunError if the disk is full: what was done is kept. `progress` counts the jobs of this rank.
[[nodiscard]] std::optional<JobResults> run_stored_jobs(const StoredJobs& jobs, const std::function<std::string(std::size_t k)>& job,
                                                        const ProgressFn& progress = {}, const std::atomic<bool>* stop = nullptr);

/// Removes the checkpoints in `folder`, and the folder if nothing else is in it.
void remove_stored_jobs(const std::filesystem::path& folder);

}  // namespace misfit
