#include "misfit/workflow/batch.h"

#include <fmt/format.h>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/text.h"
#include "misfit/data/curve_coefficient.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/jobs/job_queue.h"
#include "misfit/jobs/ranks.h"
#include "misfit/report/figure_batch.h"
#include "misfit/uncertainty/scatter.h"
#include "misfit/workflow/batch_list.h"
#include "misfit/workflow/stages.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

void take(const std::string& before, const std::map<std::string, Estimate>& from, BatchRow& row) {
  for (const auto& [name, e] : from) {
    if (!is_curve_coefficient(name)) row.values[before + name] = e;
  }
}

BatchRow row_of(const BatchRow& study, const Fit& fit) {
  BatchRow row = study;
  row.method = fit.method;
  row.status = to_string(fit.status);
  row.message = fit.message;
  if (!fit.usable()) return row;
  if (fit.trim) row.values["trim"] = *fit.trim;
  take("", fit.parameters, row);
  take("noise of ", fit.noise, row);
  take("force on ", fit.force, row);
  row.rms = fit.rms;
  return row;
}

BatchRow failed(BatchRow study, const std::exception& error) {
  study.status = to_string(FitStatus::failed);
  study.message = error.what();
  return study;
}

/// As files_of_study() where the study can be read; else its words.
std::string hashes_of(const fs::path& study) {
  std::vector<fs::path> files;
  try {
    files = files_of_study(read_study(study));
  } catch (const InputError& error) {
    return std::string(" ") + error.what();
  }
  std::string text;
  for (const fs::path& file : files) {
    try {
      text += " " + hash_file(file);
    } catch (const InputError& error) {
      text += std::string(" ") + error.what();
    }
  }
  return text;
}

/// A batch of studies: each is one job with a run folder of its own below the batch's.
class BatchJob {
 public:
  BatchJob(const SessionOptions& options, const std::vector<std::string>& studies, const Registry& registry)
      : options_(options),
        registry_(registry),
        entries_(batch_entries(studies)),
        folder_(options.out.empty() ? batch_folder(studies) : fs::path(options.out)) {}

  [[nodiscard]] const fs::path& folder() const { return folder_; }
  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  [[nodiscard]] std::vector<fs::path> studies() const {
    std::vector<fs::path> files;
    for (const BatchEntry& entry : entries_) files.push_back(entry.file);
    return files;
  }

  /// The rows of one study as text. What is wrong with the study is in them; what is wrong with the machine (no space, no memory) is
  /// thrown, so that the same command does this study again.
  [[nodiscard]] std::string run(std::size_t k) const {
    BatchRow study;
    study.study = entries_[k].name;
    study.path = entries_[k].file.string();
    study.folder = (fs::path("studies") / study.study).string();
    std::vector<BatchRow> rows;
    try {
      Session session(options_of(k), registry_, RunFolder::Access::write);
      for (const Fit& fit : fit_stage(session)) rows.push_back(row_of(study, fit));
    } catch (const MachineError&) {
      throw;
    } catch (const InputError& error) {
      rows = {failed(study, error)};
    } catch (const RunError& error) {
      if (interrupted()) throw;
      rows = {failed(study, error)};
    }
    return batch_rows_text(rows);
  }

  /// Of all studies with all that they name, as far as it can be read.
  [[nodiscard]] std::string digest() const {
    std::string text = hash_of_program() + fmt::format(" {} {}", options_.seed.value_or(0), fmt::join(options_.methods, " "));
    if (options_.time_limit) text += fmt::format(" {} s", *options_.time_limit);
    for (const BatchEntry& entry : entries_) text += "\n" + entry.file.string() + hashes_of(entry.file);
    return hash_text(text);
  }

 private:
  [[nodiscard]] SessionOptions options_of(std::size_t k) const {
    SessionOptions out = options_;
    out.study = entries_[k].file.string();
    out.out = (folder_ / "studies" / entries_[k].name).string();
    out.threads = 1;
    out.listener = {};
    return out;
  }

  SessionOptions options_;
  const Registry& registry_;
  std::vector<BatchEntry> entries_;
  fs::path folder_;
};

Batch merged(const JobResults& results) {
  Batch batch;
  for (std::size_t k = 0; k < results.size(); ++k) {
    for (BatchRow& row : batch_rows_from(results.result(k))) batch.rows.push_back(std::move(row));
  }
  batch.summary = summarise(batch.rows);
  return batch;
}

}  // namespace

std::optional<FittedBatch> fit_batch(const SessionOptions& options, const std::vector<std::string>& studies, const Registry& registry) {
  const BatchJob job(options, studies, registry);
  std::optional<RunFolder> folder;
  on_first_rank([&] {
    folder.emplace(job.folder(), RunOrigin{options.command, options.seed.value_or(1), {}, {job.studies(), options.force}});
    if (!folder->lost_record().empty()) options.listener.hear(folder->lost_record());
  });
  const StoredJobs jobs{job.folder() / "checkpoints", job.digest(), job.size(), options.threads};
  const ProgressFn progress = options.listener.begin("batch of " + counted(job.size(), "study", "studies"));
  const JobResults results = finished(run_stored_jobs(
      jobs, [&](std::size_t k) { return job.run(k); }, progress, &interrupted()));
  stop_if_interrupted();
  if (!ranks().first()) return std::nullopt;
  FittedBatch out{merged(results), job.folder()};
  const PartFolder part(job.folder());
  write_batch(part.path(), out.batch);
  report::write_batch_figures(part.path() / "figures", out.batch);
  folder->commit(part, {"batch", options.command, {{"settings", job.digest()}}});
  return out;
}

}  // namespace misfit
