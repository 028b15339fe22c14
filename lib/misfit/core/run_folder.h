#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace misfit {

/// One entry of run.json.
struct StageRecord {
  std::string stage;                          ///< "calibrate", "fit/output_error"
  std::string command;                        ///< command line that made it
  std::map<std::string, std::string> inputs;  ///< name → hash (files, and "settings" for the part of the study it depends on)
  std::vector<std::string> outputs;           ///< paths relative to the run folder
  double seconds = 0.0;
  std::string version = {}, commit = {};  ///< of the program that made it: filled by RunFolder::record
};

/// The output folder of a study. run.json is rewritten (atomically) after every stage.
class RunFolder {
 public:
  /// Makes the folder (it goes with this object if nothing was put into it) and reads run.json if there is one (an unreadable one is
  /// treated as absent, said on stderr). `study`: the file whose results these are; run.json names it relative to the folder.
  RunFolder(std::filesystem::path dir, std::string command, unsigned long seed, std::filesystem::path study = {});

  [[nodiscard]] const std::filesystem::path& path() const { return dir_; }
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return dir_ / name; }

  /// True if `stage` ran before with exactly these inputs and the same program version and commit, and all its outputs are still there.
  [[nodiscard]] bool up_to_date(const std::string& stage, const std::map<std::string, std::string>& inputs) const;
  void record(const StageRecord& record);
  [[nodiscard]] const std::map<std::string, StageRecord>& stages() const { return stages_; }
  /// The study that run.json names, if it is another one than this folder was opened for and still exists (one that was renamed or moved is
  /// taken to be this one).
  [[nodiscard]] std::optional<std::filesystem::path> other_study() const;

 private:
  /// Removes a folder that we made, if it is empty; on the first rank only, others may still be about to write.
  class Made {
   public:
    explicit Made(const std::filesystem::path& dir);
    Made(Made&& other) noexcept : dir_(std::exchange(other.dir_, {})) {}
    Made& operator=(Made&& other) noexcept {
      std::swap(dir_, other.dir_);
      return *this;
    }
    ~Made();

   private:
    std::filesystem::path dir_;  ///< empty: it was there before
  };

  void write() const;
  std::filesystem::path dir_;
  Made made_;
  std::string command_;
  unsigned long seed_;
  std::filesystem::path study_, study_before_;  ///< as given, absolute; as run.json has it
  std::map<std::string, StageRecord> stages_;
};

}  // namespace misfit
