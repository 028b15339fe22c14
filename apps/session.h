#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "misfit/core/run_folder.h"
#include "misfit/data/study.h"
#include "misfit/model/request.h"

namespace misfit {

/// Options of the command line that verbs share.
struct Options {
  std::string study;                 ///< path of study.toml
  std::string out;                   ///< empty: out/ beside the study
  std::vector<std::string> methods;  ///< empty: those of the study
  int threads = 0;                   ///< 0: one per core
  bool has_seed = false;
  unsigned long seed = 1;
  bool quiet = false, json = false;
  long runs = 0;                     ///< of `uncertainty`; 0: as the study says
  std::vector<std::string> studies;  ///< of `batch`: lists, folders, studies
  std::string effect;                ///< of `add`, and of `effects` with a study
  bool automatic = false;            ///< discover --auto
  bool force = false;                ///< write over files that misfit did not make
  std::string check_video;           ///< track: write the video with the track drawn to this file
  std::string command;               ///< the command line as typed, for run.json
};

struct FilterWork;

/// Of several ranks the first alone writes into run folders of studies.
[[nodiscard]] RunFolder::Access access_of_rank();

/// A study opened for work: what was asked, the run folder, and the hashes that decide what must be done again. InputError if the run
/// folder holds the results of another study, or one of the small files that the study names (references, tables of curves; sweep and data
/// where a video is to be tracked first) is not as it must be.
struct Session {
  Session(const Options& options, const Registry& registry, RunFolder::Access access = access_of_rank());

  Options options;
  Study study;
  std::shared_ptr<const Registry> declared;  ///< what the program knows and what the study declares
  const Registry& registry;                  ///< the same
  StudyModel model;
  RunFolder folder;
  std::string program;                ///< hash of the running program: another build does everything again
  std::filesystem::path parent = {};  ///< run folder of the parent rung: what it read from videos and pictures need not be read again
  std::shared_ptr<const FilterWork> filter;  ///< filter_error as estimated in this run of the program, for the stages after it (stages.h)

  [[nodiscard]] std::vector<std::string> methods() const { return options.methods.empty() ? study.methods : options.methods; }
  /// {"program", "settings"} and the files, hashed: the inputs of a stage.
  [[nodiscard]] std::map<std::string, std::string> inputs(const std::string& settings,
                                                          const std::vector<std::filesystem::path>& files) const;
  /// Does a stage unless it was done from the same inputs and its files are as they were written (those that are not are said on stderr):
  /// `make` writes them into the folder that it is given, as they are to lie in the run folder, and they come to their places when all are
  /// whole (RunFolder). `files`: those that are known beforehand, so that what must not be written over is refused before the work. What
  /// follows reads the results from the run folder: so it is the same whether the stage was done now or before.
  void do_stage(const std::string& stage, const std::map<std::string, std::string>& inputs, const std::vector<std::string>& files,
                const std::function<void(const std::filesystem::path&)>& make);
  /// The same, whether it was done before or not.
  void redo_stage(const std::string& stage, const std::map<std::string, std::string>& inputs, const std::vector<std::string>& files,
                  const std::function<void(const std::filesystem::path&)>& make);
  /// Where a stage's files lie; none if it was not done.
  [[nodiscard]] std::vector<std::filesystem::path> files_of_stage(const std::string& stage) const;
  /// True if this stage was done from the same inputs in the run folder of the parent rung: its files are then copied from there, and
  /// run.json says so with their hashes.
  [[nodiscard]] bool copied_from_below(const std::string& stage, const std::map<std::string, std::string>& inputs);
  /// A line on stderr unless quiet.
  void say(const std::string& line) const;
};

/// Of the running program: computed once.
[[nodiscard]] const std::string& hash_of_program();
/// Every file that a study names, itself first.
[[nodiscard]] std::vector<std::filesystem::path> files_of_study(const Study& study);

/// True after Ctrl-C: stages finish what they are at, write, and stop. The second Ctrl-C ends the program at once.
[[nodiscard]] const std::atomic<bool>& interrupted();
void watch_interrupts();
/// RunError "interrupted; …" if Ctrl-C was pressed: called between stages, when everything done so far is on disk.
void stop_if_interrupted();

}  // namespace misfit
