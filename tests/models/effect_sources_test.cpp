// How the effects are written: by name. Read from their sources, since a program cannot see an enum that is not there.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/paths.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

struct SourceFile {
  std::string path, text;
};

/// Every file with an effect: of misfit, of the tests, of the project that shows how to add one, of the benchmarks.
std::vector<SourceFile> effect_sources() {
  std::vector<SourceFile> sources;
  for (const char* folder : {"models", "tests/effects", "tests/package/effects", "tests/benchmark"}) {
    for (const auto& entry : fs::recursive_directory_iterator(paths::source() / folder)) {
      if (entry.path().extension() != ".cpp") continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      if (text.str().find("\nMISFIT_EFFECT(") != std::string::npos) sources.push_back({entry.path().string(), text.str()});
    }
  }
  return sources;
}

TEST(EffectSources, FormulasIndexByNameAndNotByNumber) {
  const std::regex number(R"(\b(in\.[qczk]|F|P|y|drift|out)\[[0-9]+\])");
  const auto sources = effect_sources();
  ASSERT_GE(sources.size(), 50U);
  for (const auto& source : sources) {
    std::smatch found;
    EXPECT_FALSE(std::regex_search(source.text, found, number)) << source.path << " has " << found.str();
  }
}

TEST(EffectSources, EveryListHasTheEnumThatIsComparedWithIt) {
  const std::vector<std::pair<std::string, std::string>> enums = {
      {"quantities", "Quantity"}, {"ports", "Port"}, {"constants", "Constant"}, {"coefficients", "Coefficient"}, {"states", "State"}};
  for (const auto& source : effect_sources()) {
    for (const auto& [list, name] : enums) {
      if (source.text.find(" " + list + "[] = ") == std::string::npos) continue;
      EXPECT_NE(source.text.find("enum " + name + " {"), std::string::npos) << source.path << " has `" << list << "` without enum " << name;
    }
  }
}

TEST(EffectSources, EntriesOfTheListsAndExamplesNameTheirFields) {
  // An entry that begins with a text or an empty list; constants alone are a list of texts.
  const std::regex positional(R"re(\{("|\{\}, )[^\n]*)re"), constants(R"re(constants\[\] = \{[^}]*\};)re");
  for (const auto& source : effect_sources()) {
    const std::string text = std::regex_replace(source.text.substr(source.text.find("[] = ")), constants, "");
    std::smatch found;
    EXPECT_FALSE(std::regex_search(text, found, positional)) << source.path << ": " << found.str();
  }
}

}  // namespace
}  // namespace misfit
