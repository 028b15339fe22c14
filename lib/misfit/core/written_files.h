#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace misfit {

/// What misfit may write over in a folder of results. The rule, for every file that it writes: never through a link, never over one of
/// `inputs`, and over a file that it did not make only with `force`.
struct WriteRules {
  std::vector<std::filesystem::path> inputs;  ///< protected whatever their names: recognised by device and inode, so links count as well
  bool force = false;                         ///< the user has said --force
};

/// Throws WriteError, naming the file and what would allow it, unless FOLDER/NAME may be written. `ours`: misfit made the file that is
/// there. Every folder between FOLDER and the file must be a folder or not be there. FOLDER itself may be a link: the user named it.
void check_place(const std::filesystem::path& folder, const std::string& name, const WriteRules& rules, bool ours);

/// A folder on the way: throws WriteError unless it is a folder, or is not there yet.
void check_folder(const std::filesystem::path& folder);

/// The same for a file that the command line names: its folder must exist. InputError.
void check_place(const std::filesystem::path& file, const WriteRules& rules);

/// A hidden folder inside `folder` in which results are made; it goes, with what was not put into its place, at the end of its scope. All
/// temporary files of misfit lie in such folders, so that what a sudden end leaves behind is found and removed (sweep()).
class PartFolder {
 public:
  explicit PartFolder(std::filesystem::path folder);
  ~PartFolder();
  PartFolder(const PartFolder&) = delete;
  PartFolder& operator=(const PartFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Every file in it, as "figures/motion.svg", sorted.
  [[nodiscard]] std::vector<std::string> files() const;
  /// Renames the files into `folder`, making folders on the way, and flushes the folders to the device. WriteError.
  void put_into_place(const std::vector<std::string>& names) const;

  /// Removes what ended programs left in `folder`. Only for who holds the folder (FolderLock).
  static void sweep(const std::filesystem::path& folder);

 private:
  std::filesystem::path folder_, path_;
};

/// Writes files into `folder`, making it: `make` writes them into a folder that it is given, and they come into their places when all are
/// whole. `known`: names that are checked before: InputError (WriteRules). WriteError where another is in the way afterwards. In both cases
/// nothing has changed.
void write_files(const std::filesystem::path& folder, const WriteRules& rules, const std::vector<std::string>& known,
                 const std::function<void(const std::filesystem::path&)>& make);

/// One misfit at a time writes in a folder: held as long as it lives, given back by the system when the program ends in whatever way.
class FolderLock {
 public:
  /// RunError if another process holds it. Where the file system has no locks, nothing is held.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace misfit
