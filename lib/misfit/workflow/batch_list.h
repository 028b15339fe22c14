#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace misfit {

/// One study of a batch.
struct BatchEntry {
  std::string name;            ///< short, unique: its folder's name (behind those above it where several have it)
  std::filesystem::path file;  ///< of its study.toml
};

/// What `misfit batch` is given: studies, folders (searched for study.toml, but not below one that was found, nor in hidden ones), lists
/// (text files with one study or folder per line, taken from the list's folder; # begins a comment). In order, each study once. InputError:
/// an argument that is not there, a folder without any study, nothing at all. A study named in a list that is not there is kept: it fails
/// on its own.
[[nodiscard]] std::vector<BatchEntry> batch_entries(const std::vector<std::string>& arguments);

/// Where the results go unless --out says otherwise: batch/ beside the first list or study, or in the first folder.
[[nodiscard]] std::filesystem::path batch_folder(const std::vector<std::string>& arguments);

}  // namespace misfit
