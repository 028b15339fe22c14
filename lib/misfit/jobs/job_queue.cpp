#include "misfit/jobs/job_queue.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/written_files.h"
#include "misfit/jobs/ranks.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view prefix = "checkpoint_";

bool is_checkpoint(const fs::path& file) { return file.extension() == ".bin" && file.filename().string().starts_with(prefix); }

std::vector<fs::path> checkpoints_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (is_checkpoint(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Numbers of the jobs of this rank that nobody has done yet.
std::vector<std::size_t> left_to_do(const StoredJobs& jobs) {
  std::vector<bool> done(jobs.count, false);
  for (const fs::path& file : checkpoints_in(jobs.folder)) {
    for (const CheckpointEntry& entry : read_checkpoint(file, jobs.digest).entries) {
      if (entry.job < jobs.count) done[entry.job] = true;
    }
  }
  std::vector<std::size_t> left;
  const auto rank = static_cast<std::size_t>(ranks().rank()), size = static_cast<std::size_t>(ranks().size());
  for (std::size_t k = rank; k < jobs.count; k += size) {
    if (!done[k]) left.push_back(k);
  }
  return left;
}

}  // namespace

JobResults stored_results(const StoredJobs& jobs) {
  JobResults results;
  results.files_ = checkpoints_in(jobs.folder);
  results.places_.resize(jobs.count);
  for (std::size_t f = 0; f < results.files_.size(); ++f) {
    for (const CheckpointEntry& entry : read_checkpoint(results.files_[f], jobs.digest).entries) {
      if (entry.job >= jobs.count || results.places_[entry.job].file >= 0) continue;
      if (entry.size > std::numeric_limits<std::uint32_t>::max()) throw RunError("the result of a job is too large");
      results.places_[entry.job] = {entry.offset, static_cast<std::uint32_t>(entry.size), static_cast<std::int32_t>(f)};
    }
  }
  return results;
}

std::string JobResults::result(std::size_t job) const {
  const Place& place = places_.at(job);
  if (place.file < 0) throw RunError("the result of job " + std::to_string(job) + " is not in " + files_.front().parent_path().string());
  return read_checkpoint_entry(files_[static_cast<std::size_t>(place.file)], {job, place.offset, place.size});
}

std::optional<JobResults> run_stored_jobs(const StoredJobs& jobs, const std::function<std::string(std::size_t)>& job,
                                          const ProgressFn& progress, const std::atomic<bool>* stop) {
  check_folder(jobs.folder);
  make_writable_folder(jobs.folder);
  const std::vector<std::size_t> left = left_to_do(jobs);
  const auto rank = static_cast<std::size_t>(ranks().rank()), size = static_cast<std::size_t>(ranks().size());
  const std::size_t own = jobs.count > rank ? (jobs.count - rank - 1) / size + 1 : 0, before = own - left.size();
  bool finished = true;
  if (!left.empty() || rank == 0) {
    CheckpointWriter writer(jobs.folder / (std::string(prefix) + std::to_string(rank) + ".bin"), jobs.digest);
    const auto one = [&](std::size_t i) { writer.append(left[i], job(left[i])); };
    const auto told = [&](std::size_t done, std::size_t) {
      if (progress) progress(before + done, own);
    };
    finished = run_jobs(left.size(), jobs.threads > 0 ? jobs.threads : threads_of_rank(), one, told, stop);
    writer.sync();
  }
  if (!ranks().agree(finished)) return std::nullopt;
  return stored_results(jobs);
}

void remove_stored_jobs(const std::filesystem::path& folder) {
  std::error_code none;
  if (fs::is_symlink(folder, none)) return;
  for (const fs::path& file : checkpoints_in(folder)) {
    if (is_checkpoint_of_ours(file)) fs::remove(file, none);
  }
  fs::remove(folder, none);
}

}  // namespace misfit
