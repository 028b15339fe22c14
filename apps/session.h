#pragma once

#include <atomic>
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
  std::string effect;                ///< of `add`
  bool automatic = false;            ///< discover --auto
  bool force = false;                ///< init: write over a study
  std::string check_video;           ///< track: write the video with the track drawn to this file
  std::string command;               ///< the command line as typed, for run.json
};

struct FilterWork;

/// A study opened for work: what was asked, the run folder, and the hashes that decide what must be done again. InputError if the run
/// folder holds the results of another study.
struct Session {
  Session(const Options& options, const Registry& registry);

  Options options;
  Study study;
  std::shared_ptr<const Registry> declared;  ///< what the program knows and what the study declares
  const Registry& registry;                  ///< the same
  StudyModel model;
  RunFolder folder;
  std::string program;                       ///< hash of the running program: another build does everything again
  std::filesystem::path below = {};          ///< run folder of the rung below: what it read from videos and pictures need not be read again
  std::shared_ptr<const FilterWork> filter;  ///< filter_error as estimated in this run of the program, for the stages after it (stages.h)

  [[nodiscard]] std::vector<std::string> methods() const { return options.methods.empty() ? study.methods : options.methods; }
  /// {"program", "settings"} and the files, hashed: the inputs of a stage.
  [[nodiscard]] std::map<std::string, std::string> inputs(const std::string& settings,
                                                          const std::vector<std::filesystem::path>& files) const;
  /// True if this stage was done from the same inputs in the run folder of the rung below: its files are then copied from there, and
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
