#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "misfit/core/written_files.h"

namespace misfit {

/// What a stage depends on, name → hash: files, and "settings" for the part of the study.
using StageInputs = std::map<std::string, std::string>;

/// One entry of run.json.
struct StageRecord {
  std::string stage;    ///< "calibrate", "fit/output_error"
  std::string command;  ///< command line that made it
  StageInputs inputs;
  std::vector<std::string> outputs = {};  ///< paths relative to the run folder: filled by RunFolder::commit
  double seconds = 0.0;
  std::string version = {}, commit = {};  ///< of the program that made it: filled by RunFolder::commit
};

/// What makes the results of a run folder, for run.json.
struct RunOrigin {
  std::string command;  ///< command line
  unsigned long seed = 1;
  std::filesystem::path study = {};  ///< the file whose results these are; run.json names it relative to the folder
  WriteRules rules = {};
};

/// The output folder of a study, and what misfit made in it. run.json has one entry per stage, and every file that misfit made with the
/// hash of what was put there ("files"): only these are ever written over or removed, and a stage whose files are missing or were changed
/// is done again. A copy, .run.json, keeps that list where run.json was damaged.
///
/// A stage makes its files in a PartFolder; commit() puts them into their places: first run.json says what will be there, then the files
/// are renamed. Whatever moment the program ends at, a file is the old one or the whole new one, and one that is not the one which run.json
/// names is made again.
class RunFolder {
 public:
  /// `write`: makes the folder (it goes with this object if nothing was put into it) and keeps other processes out (FolderLock).
  /// `read`: looks only; others may be at work in it, and it need not be there.
  enum class Access { write, read };

  /// Where run.json cannot be read, all stages count
  /// as not done (lost_record()).
  RunFolder(std::filesystem::path dir, RunOrigin origin, Access access = Access::write);

  [[nodiscard]] const std::filesystem::path& path() const { return dir_; }
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return dir_ / name; }
  [[nodiscard]] Access access() const { return access_; }
  /// Why all stages run again although results are there; else empty.
  [[nodiscard]] const std::string& lost_record() const { return lost_record_; }

  /// True if `stage` ran before with exactly these inputs and the same program version and commit, and all its files are as they were
  /// written.
  [[nodiscard]] bool up_to_date(const std::string& stage, const StageInputs& inputs) const;
  /// Names of the files of `stage` that are not as they were written; none if the stage was not done.
  [[nodiscard]] std::vector<std::string> damaged(const std::string& stage) const;
  /// Is this file as misfit wrote it?
  [[nodiscard]] bool intact(const std::string& name) const;

  /// WriteError unless these files may be written (WriteRules): to be called before the work.
  void check_places(const std::vector<std::string>& names) const;
  /// Puts the files of `part` into their places and records the stage; what the stage had made before and did not make again is removed
  /// where it is as it was written. WriteError: also where a file may not be written (WriteRules).
  void commit(const PartFolder& part, StageRecord record);

  [[nodiscard]] const std::map<std::string, StageRecord>& stages() const { return stages_; }
  /// The study that run.json names, if it is another one than this folder was opened for and still exists (one that was renamed or moved is
  /// taken to be this one).
  [[nodiscard]] std::optional<std::filesystem::path> other_study() const;

 private:
  /// Makes a folder and removes it again if it is empty at the end, and was not there before.
  class Made {
   public:
    Made(const std::filesystem::path& dir, Access access);
    Made(Made&& other) noexcept : dir_(std::exchange(other.dir_, {})) {}
    Made& operator=(Made&& other) noexcept {
      std::swap(dir_, other.dir_);
      return *this;
    }
    ~Made();

   private:
    std::filesystem::path dir_;  ///< empty: it was there before
  };

  void read();
  void remove_dropped(const StageRecord& before, const std::vector<std::string>& names);
  void write() const;

  std::filesystem::path dir_;
  Access access_;
  Made made_;
  std::unique_ptr<FolderLock> lock_;
  RunOrigin origin_;                    ///< its study absolute
  std::filesystem::path study_before_;  ///< as run.json has it
  std::string lost_record_;
  std::map<std::string, StageRecord> stages_;
  std::map<std::string, std::string>
      files_;  ///< what misfit made: name → hash; an empty hash fits nothing (run.json of an earlier version)
};

}  // namespace misfit
