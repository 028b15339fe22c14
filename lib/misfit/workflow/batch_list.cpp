#include "misfit/workflow/batch_list.h"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/shown.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

constexpr const char* usual_name = "study.toml";

std::string trimmed(const std::string& line) {
  const std::string text = line.substr(0, line.find('#'));
  const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// study.toml of the folder or, where there is none, of the folders below it, in the order of their names.
void search(const fs::path& folder, std::vector<fs::path>& found) {
  std::error_code none;
  if (fs::is_regular_file(folder / usual_name, none)) {
    found.push_back(folder / usual_name);
    return;
  }
  std::vector<fs::path> below;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory(none) && !name.starts_with(".") && !entry.is_symlink(none)) below.push_back(entry.path());
  }
  std::sort(below.begin(), below.end());
  for (const fs::path& next : below) search(next, found);
}

void read_list(const fs::path& list, std::vector<fs::path>& found) {
  std::istringstream lines(read_file(list));
  const std::size_t before = found.size();
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::string name = trimmed(line);
    if (name.empty()) continue;
    if (name.find('\0') != std::string::npos)
      throw InputError({list.string(), number, 0}, "'" + shown(name) + "': a file name cannot hold the character NUL");
    const fs::path path = (list.parent_path() / name).lexically_normal();
    std::error_code none;
    if (fs::is_directory(path, none)) {
      search(path, found);
    } else if (path.extension() == ".toml") {
      found.push_back(path);
    } else {
      throw InputError({list.string(), number, 0},
                       "a study (.toml) or a folder is expected on every line, this is neither: '" + shown(name) + "'");
    }
  }
  if (found.size() == before) throw InputError({list.string(), 0, 0}, "names no study: one per line is expected");
}

void add_argument(const std::string& argument, std::vector<fs::path>& found) {
  const fs::path path = argument;
  std::error_code none;
  if (fs::is_directory(path, none)) {
    const std::size_t before = found.size();
    search(path, found);
    if (found.size() == before) throw InputError({path.string(), 0, 0}, "no study.toml in this folder or below it");
  } else if (path.extension() == ".toml" && fs::exists(path, none)) {
    found.push_back(path);
  } else {
    read_list(path, found);
  }
}

/// The folder's name, and the file's where that is not study.toml, behind those of `above` folders further up; of a path that has not so
/// many the hash.
std::string name_of(const fs::path& file, int above) {
  const fs::path whole = fs::absolute(file).lexically_normal();
  fs::path folder = whole.parent_path();
  std::string name = folder.filename().string();
  if (file.filename() != usual_name) name += "_" + file.stem().string();
  for (int k = 0; k < above; ++k) {
    folder = folder.parent_path();
    if (folder.filename().empty()) return name + "_" + hash_text(whole.string());
    name.insert(0, folder.filename().string() + "_");
  }
  return name;
}

/// Studies of the same name are prefixed by the folders above, one by one, until they differ: names depend on which studies there are, not
/// on their order.
void give_names(std::vector<BatchEntry>& entries) {
  std::vector<int> above(entries.size(), 0);
  constexpr int deepest = 200;
  bool clash = true;
  for (int round = 0; clash && round < deepest; ++round) {
    std::map<std::string, std::vector<std::size_t>> same;
    for (std::size_t k = 0; k < entries.size(); ++k) {
      entries[k].name = name_of(entries[k].file, above[k]);
      same[entries[k].name].push_back(k);
    }
    clash = false;
    for (const auto& [name, studies] : same) {
      if (studies.size() == 1) continue;
      clash = true;
      for (const std::size_t k : studies) ++above[k];
    }
  }
}

}  // namespace

std::vector<BatchEntry> batch_entries(const std::vector<std::string>& arguments) {
  std::vector<fs::path> found;
  for (const std::string& argument : arguments) add_argument(argument, found);
  std::vector<BatchEntry> entries;
  std::set<fs::path> seen;
  for (const fs::path& file : found) {
    std::error_code none;
    const fs::path whole = fs::weakly_canonical(file, none);
    if (!seen.insert(none ? file : whole).second) continue;
    entries.push_back({"", file});
  }
  give_names(entries);
  return entries;
}

fs::path batch_folder(const std::vector<std::string>& arguments) {
  const fs::path first = arguments.front();
  return (fs::is_directory(first) ? first : first.parent_path()) / "batch";
}

}  // namespace misfit
