#include "misfit/core/written_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <set>
#include <system_error>

#include "misfit/core/files.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

constexpr const char* hidden = ".misfit-part";

using Reason = std::optional<std::string>;

Reason link(const fs::path& file) {
  return file.string() + ": is a link, and misfit never writes through links: remove it, or write elsewhere (--out DIR)";
}

/// Why a folder cannot be used, or made, on the way to a file.
Reason against_folder(const fs::path& folder) {
  std::error_code none;
  const fs::file_status status = fs::symlink_status(folder, none);
  if (fs::is_symlink(status)) return link(folder);
  if (fs::exists(status) && !fs::is_directory(status))
    return folder.string() + ": is a file where misfit needs a folder: move it away, or write elsewhere (--out DIR)";
  return std::nullopt;
}

Reason against_file(const fs::path& file, const WriteRules& rules, bool ours) {
  std::error_code none;
  const fs::file_status status = fs::symlink_status(file, none);
  if (!fs::exists(status)) return std::nullopt;
  for (const fs::path& input : rules.inputs) {
    std::error_code other;
    if (fs::equivalent(file, input, other) && !other)
      return file.string() + ": is an input, " + input.filename().string() + ", which is never written over: write elsewhere (--out DIR)";
  }
  if (fs::is_symlink(status)) return link(file);
  if (fs::is_directory(status)) return file.string() + ": is a folder where misfit writes a file: move it away, or use --out DIR";
  if (!ours && !rules.force)
    return file.string() + " is there already, and may be yours: --force writes over it, --out DIR writes elsewhere";
  return std::nullopt;
}

Reason against_place(const fs::path& folder, const std::string& name, const WriteRules& rules, bool ours) {
  fs::path at = folder;
  const fs::path within = fs::path(name).parent_path();
  for (const fs::path& part : within) {
    if (auto reason = against_folder(at /= part)) return reason;
  }
  return against_file(folder / name, rules, ours);
}

void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);  // not every file system can: then there is nothing more to be done
  ::close(descriptor);
}

}  // namespace

void check_folder(const fs::path& folder) {
  if (const auto reason = against_folder(folder)) throw WriteError(*reason);
}

void check_place(const fs::path& folder, const std::string& name, const WriteRules& rules, bool ours) {
  if (const auto reason = against_place(folder, name, rules, ours)) throw WriteError(*reason);
}

void check_place(const fs::path& file, const WriteRules& rules) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::error_code none;
  if (!fs::is_directory(folder, none))
    throw InputError(file.string() + ": cannot be written: the folder " + folder.string() + " does not exist");
  if (const auto reason = against_file(file, rules, false)) throw InputError(*reason);
}

PartFolder::PartFolder(fs::path folder) : folder_(std::move(folder)) {
  const fs::path all = folder_ / hidden;
  check_folder(all);
  make_writable_folder(all);
  // The numbers of two that are open at once differ; a third party cannot be at work here.
  for (int number = 0;; ++number) {
    path_ = all / std::to_string(number);
    std::error_code error;
    if (fs::create_directory(path_, error)) return;
    if (error) throw WriteError(path_.string() + ": the folder cannot be made: " + error.message());
  }
}

PartFolder::~PartFolder() {
  std::error_code none;
  fs::remove_all(path_, none);
  fs::remove(path_.parent_path(), none);  // not while another is open: it is not empty then
}

std::vector<std::string> PartFolder::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(path_)) {
    if (!entry.is_directory()) names.push_back(entry.path().lexically_relative(path_).generic_string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void PartFolder::put_into_place(const std::vector<std::string>& names) const {
  std::set<fs::path> folders;
  for (const std::string& name : names) {
    const fs::path file = folder_ / name;
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    if (!error) fs::rename(path_ / name, file, error);
    if (error) throw WriteError(file.string() + ": cannot be written: " + error.message());
    folders.insert(file.parent_path());
  }
  for (const fs::path& folder : folders) sync_folder(folder);
}

void PartFolder::sweep(const fs::path& folder) {
  std::error_code none;
  fs::remove_all(folder / hidden, none);  // of a link: the link itself
}

void write_files(const fs::path& folder, const WriteRules& rules, const std::vector<std::string>& known,
                 const std::function<void(const fs::path&)>& make) {
  for (const std::string& name : known) {
    if (const auto reason = against_place(folder, name, rules, false)) throw InputError(*reason);
  }
  std::error_code none;
  const bool before = fs::exists(folder, none);
  make_writable_folder(folder);
  try {
    const FolderLock lock(folder);
    PartFolder::sweep(folder);
    const PartFolder part(folder);
    make(part.path());
    const std::vector<std::string> names = part.files();
    for (const std::string& name : names) check_place(folder, name, rules, false);
    part.put_into_place(names);
  } catch (...) {
    if (!before) fs::remove(folder, none);  // if it is empty
    throw;
  }
}

FolderLock::FolderLock(const fs::path& folder) {
  descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) return;
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw RunError("another misfit is at work in " + folder.string() + ": wait for its end, or write elsewhere (--out DIR)");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace misfit
