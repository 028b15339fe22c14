#include "apps/what_next.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "misfit/core/files.h"
#include "misfit/core/shell_word.h"
#include "misfit/core/shown.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

struct FolderContents {
  std::vector<std::string> studies;  ///< folders
  std::vector<std::string> tables;   ///< CSV files
};

FolderContents look(const fs::path& folder) {
  FolderContents out;
  std::error_code none;
  for (const fs::directory_entry& item : fs::directory_iterator(folder, none)) {
    const std::string name = item.path().filename().string();
    if (item.is_directory(none) && fs::exists(item.path() / "study.toml", none)) out.studies.push_back(name);
    if (item.is_regular_file(none) && item.path().extension() == ".csv") out.tables.push_back(name);
  }
  std::erase_if(out.tables, [&](const std::string& table) { return fs::exists(folder / fs::path(table).stem() / "study.toml", none); });
  std::sort(out.studies.begin(), out.studies.end());
  std::sort(out.tables.begin(), out.tables.end());
  return out;
}

/// One command per name, five at most.
std::string commands(const std::vector<std::string>& names, const char* before) {
  constexpr std::size_t most = 5;
  std::string out;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
    out += fmt::format("  misfit {} {}\n", before, printable(shell_word(names[i])));
  if (names.size() > most) out += fmt::format("  … and {} more\n", names.size() - most);
  return out;
}

/// What a study has come to, in one line; "" where it has no verdict that can be read.
std::string sentence_of(const fs::path& study) {
  try {
    return nlohmann::json::parse(read_file(study / "out/verdict.json")).at("sentence").get<std::string>();
  } catch (const std::exception&) {
    return "";
  }
}

/// Those that have come to a verdict, with it; then how the others are run.
std::string of_studies(const fs::path& folder, std::vector<std::string> names) {
  std::string out;
  constexpr std::size_t most = 5;
  std::size_t said = 0;
  std::erase_if(names, [&](const std::string& name) {
    const std::string sentence = sentence_of(folder / name);
    if (!sentence.empty() && ++said <= most)
      out += fmt::format("  {}: {}\n      report: {}\n", printable(name), printable(sentence), printable(name + "/out/report.html"));
    return !sentence.empty();
  });
  if (said > most) out += fmt::format("  … and {} more with a verdict\n", said - most);
  return out + commands(names, "run");
}

std::string of_study(const fs::path& folder) {
  std::error_code none;
  if (!fs::exists(folder / "out/run.json", none)) return "This folder is a study that has not been run:\n  misfit run .\n";
  std::string out = "This folder is a study with results in out/:\n  misfit run .               what has changed is done again\n";
  out += "  misfit discover . --auto   finds and adds what the model is missing\n";
  if (fs::exists(folder / "out/fit", none)) out += "  misfit export . --to json  the estimate for other programs\n";
  if (fs::exists(folder / "out/report.html", none)) out += "The report: out/report.html\n";
  return out;
}

}  // namespace

std::string what_next(const fs::path& folder, const fs::path& examples) {
  std::error_code none;
  std::string out = "misfit finds out what your model is missing.\n\n";
  const FolderContents found = look(folder);
  const bool study = fs::exists(folder / "study.toml", none);
  if (study) out += of_study(folder);
  if (!study && !found.studies.empty()) out += "Studies in this folder:\n" + of_studies(folder, found.studies);
  if (!study && !found.tables.empty()) out += "Recordings in this folder; a first study of one:\n" + commands(found.tables, "init");
  if (!study && found.studies.empty() && found.tables.empty()) {
    out += "No study and no CSV file in this folder. With a recording of your own (a header line, then numbers):\n  misfit init DATA.csv\n";
    if (!examples.empty())
      out += fmt::format("An example that came with misfit:\n  cp -r {} . && misfit run cascaded_tanks\n",
                         shell_word((examples / "cascaded_tanks").string()));
  }
  return out + "\nmisfit help lists verbs and topics; misfit help words says what its words mean.\n";
}

fs::path installed_examples() {
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  const fs::path examples = (program.parent_path().parent_path() / "share/doc/misfit/examples").lexically_normal();
  return !none && fs::is_directory(examples, none) ? examples : fs::path();
}

}  // namespace misfit
