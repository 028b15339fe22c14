#include "misfit/fit/methods.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "misfit/core/error.h"
#include "misfit/fit/shooting/output_error.h"
#include "tests/fit/decay.h"
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

/// From the regression's values, by which the motion runs away within a sample, there is no way.
TEST(OutputErrorFromItsOwnValues, BeginsWithVeryShortSegments) {
  const auto known = testing_models::registry_with(R"toml([states]
x = { unit = "V", scale = 1.0 }
[parameters]
a = { unit = "1/s", value = 0.5, bounds = [-1e9, 1e9], free = true }
c = { unit = "1/V^2/s", value = 0.0, bounds = [-1e9, 1e9], free = true }
[equations]
x = "-a*x + c*x^3"
[outputs]
y = { unit = "V", formula = "x", noise = 0.01 }
)toml");
  const Model model = assemble(testing_models::request_of("text"), *known);
  const std::vector<Signals> experiments{testing_decay::decay(300, 4)};
  FittedModel runs_away{{}, model, {}, {}};
  runs_away.fit.method = "equation_error";
  runs_away.fit.status = FitStatus::converged;
  runs_away.model.parameters[static_cast<std::size_t>(model.find_parameter("c"))].value = 1e8;
  EstimationTask task{model, experiments};
  task.regression = [&]() -> const FittedModel& { return runs_away; };
  const Fit fit = estimator("output_error").run(task).at.fitted.fit;
  ASSERT_EQ(fit.status, FitStatus::converged) << fit.message;
  EXPECT_THAT(fit.warnings, testing::Contains(testing::HasSubstr("the search began at the study's own")));
  OutputErrorStart options;
  options.from_regression = false;
  EXPECT_EQ(fit.linearisations, output_error({{}, model, curve_penalties(model), {}}, experiments, options).fit.linearisations);
  EXPECT_NE(fit.linearisations, output_error({{}, model, curve_penalties(model), {}}, experiments).fit.linearisations);
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
