#include "misfit/fit/methods.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "misfit/core/error.h"
#include "tests/paths.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

TEST(TableOfEstimators, EveryNameThatAStudyMayGiveIsRun) {
  for (const EstimatorInfo* info : estimators::all) {
    const Estimator& row = estimator(info->name);
    EXPECT_STREQ(row.info.name, info->name);
    EXPECT_NE(row.run, nullptr) << info->name;
    EXPECT_NE(row.refit, nullptr) << info->name;
  }
}

TEST(TableOfEstimators, MaximisesWhatHasALikelihood) {
  for (const EstimatorInfo* info : estimators::all)
    EXPECT_EQ(estimator(info->name).maximise != nullptr, info->has_likelihood) << info->name;
}

TEST(TableOfEstimators, AnUnknownNameIsAnsweredWithTheNearest) {
  try {
    static_cast<void>(estimator("outptu_error"));
    FAIL() << "an unknown name was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("output_error"));
  }
}

TEST(TableOfEstimators, TheDefaultsAreDeterministic) {
  EXPECT_THAT(default_estimators(), testing::ElementsAre("sliding_bin", "equation_error", "output_error"));
  for (const std::string& name : default_estimators()) EXPECT_TRUE(find_estimator(name)->deterministic) << name;
}

/// Lines of code, comments left out, with an estimator's name as a string.
std::vector<std::string> lines_that_name(const fs::path& file) {
  static const std::regex name(R"re(^(?!\s*//)[^"]*"(?:[^"]*[ \[(])?(sliding_bin|equation_error|output_error|filter_error)[ "])re");
  std::vector<std::string> out;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (std::regex_search(line.substr(0, line.find("//")), name)) out.push_back(file.filename().string() + ": " + line);
  }
  return out;
}

TEST(TableOfEstimators, NoOtherFileNamesOneButItsOwn) {
  std::vector<std::string> found;
  const fs::path root = paths::source();
  for (const char* folder : {"lib", "apps"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string stem = entry.path().stem().string();
      const bool own = stem == "estimators" || find_estimator(stem) != nullptr;
      if (own || (entry.path().extension() != ".cpp" && entry.path().extension() != ".h")) continue;
      for (const std::string& line : lines_that_name(entry.path())) found.push_back(line);
    }
  }
  EXPECT_THAT(found, testing::IsEmpty());
}

}  // namespace
}  // namespace misfit
