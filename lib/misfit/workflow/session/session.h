#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "misfit/core/run_folder.h"
#include "misfit/core/watch.h"
#include "misfit/data/reference.h"
#include "misfit/data/study.h"
#include "misfit/jobs/work_queue.h"
#include "misfit/model/request.h"

namespace misfit {

struct Fit;

/// Hears of long work while it goes on. An empty function: nobody listens.
struct Listener {
  std::function<void(const std::string& line)> note;  ///< what is made again, and why; where work continues
  /// Work of this name begins; what is returned is called with (done, total) as it goes on, and destroyed when it has ended.
  std::function<ProgressFn(const std::string& name)> progress;
  /// A fit of this name begins: what is returned listens to the searches in it, and is destroyed when it has ended.
  std::function<Watch::ProgressCallback(const std::string& name)> searches;
  std::function<void(const Fit&)> fitted = {};  ///< by one of the methods of a study; the others are still to come

  void hear(const std::string& line) const;  ///< a note
  /// Work of this name begins: to be called with (done, total) as long as it goes on.
  [[nodiscard]] ProgressFn begin(const std::string& name) const;
  /// A fit of this name begins; empty: nobody listens.
  [[nodiscard]] Watch::ProgressCallback progress_of(const std::string& name) const {
    return searches ? searches(name) : Watch::ProgressCallback();
  }
};

/// A study and how to work on it.
struct SessionOptions {
  std::string study;                       ///< path of study.toml, or of the folder that holds it
  std::string out = {};                    ///< the run folder; empty: out/ beside the study
  std::vector<std::string> methods = {};   ///< empty: those of the study
  int threads = 0;                         ///< 0: one per core
  std::optional<unsigned long> seed = {};  ///< instead of the study's
  long runs = 0;                           ///< of the Monte Carlo; 0: as the study says
  std::optional<double> time_limit = {};   ///< of every fit and refit [s], instead of the study's
  std::optional<double> round_limit = {};  ///< of a round of discovery [s], instead of the study's
  bool force = false;                      ///< write over files that misfit did not make
  std::string command = "C++";             ///< what run.json and the report name as the command that made a result
  Listener listener = {};
};

/// [s] For a fit of a rung that nobody asked for by itself, where no limit is given: 10 times the processor time of the fit
/// before it, at least 300 s; so generous that only what would not end comes to it, on a machine that others use, too.
[[nodiscard]] double usual_limit(const SessionOptions& options, double seconds_before);
/// [s] For a refit of discover, the same with at least 60 s: there are many of them, and one that is cut off is named and says nothing.
[[nodiscard]] double usual_refit_limit(const SessionOptions& options, double seconds_before);

struct FilterWork;

/// Of several ranks the first alone writes into run folders of studies.
[[nodiscard]] RunFolder::Access access_of_rank();

/// A study opened for work: what was asked, the run folder, and the hashes that decide what must be done again. InputError if the run
/// folder holds the results of another study, or one of the small files that the study names (references, tables of curves; sweep and data
/// where a video is to be tracked first) is not as it must be.
struct Session {
  Session(const SessionOptions& options, const Registry& registry, RunFolder::Access access = access_of_rank());

  SessionOptions options;
  Study study;
  std::shared_ptr<const Registry> declared;  ///< what the program knows and what the study declares
  const Registry& registry;                  ///< the same
  StudyModel model;
  RunFolder folder;
  std::string program;                ///< hash of the running program: another build does everything again
  std::filesystem::path parent = {};  ///< run folder of the parent rung: what it read from videos and pictures need not be read again
  bool said_program = false;          ///< that another build made what is there
  double usual_limit = 0.0;           ///< [s] of a fit where neither the options nor the study say; 0: none
  std::shared_ptr<const FilterWork> filter;  ///< filter_error as estimated in this run of the program, for the stages after it (stages.h)

  [[nodiscard]] std::vector<std::string> methods() const { return options.methods.empty() ? study.methods : options.methods; }
  /// Time limit of every fit and refit that the options or the study give [s].
  [[nodiscard]] std::optional<double> asked_limit() const { return options.time_limit ? options.time_limit : study.fit_time_limit; }
  /// Of a round of discovery.
  [[nodiscard]] std::optional<double> round_limit() const { return options.round_limit ? options.round_limit : study.discover_time_limit; }
  /// Of a fit [s]; 0: none.
  [[nodiscard]] double fit_limit() const { return asked_limit().value_or(usual_limit); }
  /// {"program", "settings"} and the files, hashed: the inputs of a stage.
  [[nodiscard]] StageInputs inputs(const std::string& settings, const std::vector<std::filesystem::path>& files) const;
  /// Does a stage unless it was done from the same inputs and its files are as they were written (those that are not: a note):
  /// `make` writes them into the folder that it is given, as they are to lie in the run folder, and they come to their places when all are
  /// whole (RunFolder). `files`: those that are known beforehand, so that what must not be written over is refused before the work. What
  /// follows reads the results from the run folder: so it is the same whether the stage was done now or before.
  void do_stage(const std::string& stage, const StageInputs& inputs, const std::vector<std::string>& files,
                const std::function<void(const std::filesystem::path&)>& make);
  /// The same, whether it was done before or not.
  void redo_stage(const std::string& stage, const StageInputs& inputs, const std::vector<std::string>& files,
                  const std::function<void(const std::filesystem::path&)>& make);
  /// Why results of a stage that are there are not those of these inputs: "they are of another build of misfit (0.2.0, 1a2b3c4; this
  /// one is 0.2.0, 5d6e7f8)", "tank.csv has changed since". Empty: they are, or there are none.
  [[nodiscard]] std::string why_outdated(const std::string& stage, const StageInputs& inputs) const;
  /// Where a stage's files lie; none if it was not done.
  [[nodiscard]] std::vector<std::filesystem::path> files_of_stage(const std::string& stage) const;
  /// True if this stage was done from the same inputs in the run folder of the parent rung: its files are then copied from there, and
  /// run.json says so with their hashes.
  [[nodiscard]] bool copied_from_parent(const std::string& stage, const StageInputs& inputs);
  /// A line for the listener.
  void note(const std::string& line) const;
  /// To be called with (done, total) of work that begins now, as long as it goes on.
  [[nodiscard]] ProgressFn progress(const std::string& name) const;
};

/// Where an effect goes without roles: those of its roles for which the system has a default.
[[nodiscard]] std::map<std::string, std::string> default_place(const Session& session, const std::string& effect);

/// One word for all these.
[[nodiscard]] std::string digest_of(const StageInputs& inputs);
/// The reference curves that a study names.
[[nodiscard]] std::vector<Reference> references(const Session& session);
/// Of the running program: computed once.
[[nodiscard]] const std::string& hash_of_program();
/// Every file that a study names, itself first.
[[nodiscard]] std::vector<std::filesystem::path> files_of_study(const Study& study);

}  // namespace misfit
