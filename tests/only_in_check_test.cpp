// Every pattern of tests/only_in_check.txt is the name of a test: one that is renamed would run in ./dev test again, unseen.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/paths.h"

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string all_tests() {
  std::string out;
  for (const auto& entry : fs::recursive_directory_iterator(paths::source() / "tests")) {
    if (entry.path().filename().string().ends_with("_test.cpp")) out += text_of(entry.path());
  }
  return out;
}

TEST(OnlyInCheck, NamesTestsThatThereAre) {
  const std::string tests = all_tests();
  std::ifstream patterns(paths::source() / "tests" / "only_in_check.txt");
  int found = 0;
  for (std::string line; std::getline(patterns, line);) {
    if (line.empty() || line.front() == '#') continue;
    const std::size_t dot = line.find('.');
    ASSERT_NE(dot, std::string::npos) << line;
    const std::string suite = line.substr(0, dot), name = line.substr(dot + 1);
    EXPECT_NE(tests.find("(" + suite + ", " + (name == "*" ? "" : name + ")")), std::string::npos) << line;
    ++found;
  }
  EXPECT_GT(found, 0);
}

}  // namespace
