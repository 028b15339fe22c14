#include "apps/batch_list.h"

#include <algorithm>
#include <set>
#include <sstream>

#include "misfit/core/error.h"
#include "misfit/core/files.h"

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
  if (fs::is_regular_file(folder / usual_name)) {
    found.push_back(folder / usual_name);
    return;
  }
  std::vector<fs::path> below;
  std::error_code none;
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
    const fs::path path = (list.parent_path() / name).lexically_normal();
    if (fs::is_directory(path)) {
      search(path, found);
    } else if (path.extension() == ".toml") {
      found.push_back(path);
    } else {
      throw InputError({list.string(), number, 0},
                       "a study (.toml) or a folder is expected on every line, this is neither: '" + name + "'");
    }
  }
  if (found.size() == before) throw InputError({list.string(), 0, 0}, "names no study: one per line is expected");
}

void add_argument(const std::string& argument, std::vector<fs::path>& found) {
  const fs::path path = argument;
  if (fs::is_directory(path)) {
    const std::size_t before = found.size();
    search(path, found);
    if (found.size() == before) throw InputError({path.string(), 0, 0}, "no study.toml in this folder or below it");
  } else if (path.extension() == ".toml" && fs::exists(path)) {
    found.push_back(path);
  } else {
    read_list(path, found);
  }
}

std::string short_name(const fs::path& file) {
  const std::string folder = fs::absolute(file).parent_path().filename().string();
  return file.filename() == usual_name ? folder : folder + "_" + file.stem().string();
}

}  // namespace

std::vector<BatchEntry> batch_entries(const std::vector<std::string>& arguments) {
  std::vector<fs::path> found;
  for (const std::string& argument : arguments) add_argument(argument, found);
  std::vector<BatchEntry> entries;
  std::set<fs::path> seen;
  std::set<std::string> names;
  for (const fs::path& file : found) {
    std::error_code none;
    const fs::path whole = fs::weakly_canonical(file, none);
    if (!seen.insert(none ? file : whole).second) continue;
    const std::string base = short_name(file);
    std::string name = base;
    for (int k = 2; !names.insert(name).second; ++k) name = base + "_" + std::to_string(k);
    entries.push_back({name, file});
  }
  return entries;
}

fs::path batch_folder(const std::vector<std::string>& arguments) {
  const fs::path first = arguments.front();
  return (fs::is_directory(first) ? first : first.parent_path()) / "batch";
}

}  // namespace misfit
