// Files and names in `…` of lib/misfit/README.md exist.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/paths.h"

namespace {

namespace fs = std::filesystem;

const fs::path root = paths::source();

std::string read(const fs::path& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> matches(const std::string& text, const std::regex& pattern, int group) {
  std::vector<std::string> out;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it) out.push_back((*it)[group]);
  return out;
}

/// Names of files relative to the repository, and every word that stands in one of them.
struct Sources {
  std::vector<std::string> files;
  std::set<std::string> words;

  Sources() {
    for (const char* folder : {"lib", "apps", "models", "tests"}) {
      for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
        if (entry.is_directory()) words.insert(entry.path().filename().string() + "_tests");  // its executable
        if (!entry.is_regular_file() || entry.path().extension() == ".md") continue;
        files.push_back(entry.path().lexically_relative(root).generic_string());
        if (entry.path().filename() == "documentation_test.cpp") continue;
        for (std::string& word : matches(read(entry.path()), std::regex(R"(\w+)"), 0)) words.insert(std::move(word));
      }
    }
  }

  /// A path from the repository or from lib/misfit, or a file's name alone; "*" stands for anything within a name.
  [[nodiscard]] bool has_file(const std::string& name) const {
    const std::string text = std::regex_replace(std::regex_replace(name, std::regex(R"(\.)"), "\\."), std::regex(R"(\*)"), "[^/]*");
    const std::regex path(name.find('/') == std::string::npos ? "(.*/)?" + text : "(lib/misfit/)?" + text);
    return std::any_of(files.begin(), files.end(), [&](const std::string& file) { return std::regex_match(file, path); });
  }
};

TEST(Documentation, FilesAndNamesOfTheDevelopersReadmeExist) {
  const Sources sources;
  std::string text = read(root / "lib/misfit/README.md");
  ASSERT_FALSE(text.empty());
  text = std::regex_replace(text, std::regex(R"(```[^`]*```)"), "");
  std::vector<std::string> missing;
  for (const std::string& quoted : matches(text, std::regex(R"(`([^`\n]+)`)"), 1)) {
    if (std::regex_match(quoted, std::regex(R"([\w/*]+\.(cpp|h|cmake|\*))"))) {
      if (!sources.has_file(quoted)) missing.push_back(quoted);
    } else if (std::regex_match(quoted, std::regex(R"([A-Za-z_][\w:]*(\(\))?)"))) {
      for (const std::string& word : matches(quoted, std::regex(R"(\w+)"), 0)) {
        if (!sources.words.contains(word)) missing.push_back(quoted);
      }
    }
  }
  EXPECT_THAT(missing, testing::IsEmpty());
}

}  // namespace
