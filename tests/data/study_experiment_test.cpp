#include <gtest/gtest.h>

#include "misfit/data/study.h"
#include "tests/data/study_folder.h"

namespace misfit {
namespace {

using Experiments = StudyFolder;

TEST_F(Experiments, AnExperimentHasOneSourceAndAnOwnName) {
  expect_parts(error_with("[[experiment]]\nname = \"a\"\n"), {"study.toml:3", "exactly one of track, video and data", "0 are given"});
  expect_parts(error_with("[[experiment]]\nname = \"a\"\ndta = \"a.csv\"\n"),
               {"study.toml:5", "dta", "unknown key 'dta' in [[experiment]]", "did you mean 'data'"});
  expect_parts(error_with("[[experiment]]\ntrack = \"track.csv\"\ndata = \"other.csv\"\n"), {"2 are given"});
  expect_parts(error_with("[[experiment]]\ntrack = \"track.csv\"\n[[experiment]]\ndata = \"other.csv\"\ncolums = {}\n"),
               {"study.toml:7", "unknown key 'colums' in [[experiment]] (number 2)", "did you mean 'columns'"});
  expect_parts(error_with("[[experiment]]\ntrack = \"track.csv\"\n[[experiment]]\ndata = \"track.csv\"\n"),
               {"two experiments are called 'track'", "line 3"});
  expect_parts(error_with("[[experiment]]\ntrack = \"track.csv\"\nname = \"../a\"\n"), {"study.toml:5", "experiment[0].name"});
  expect_parts(error_with("[[experiment]]\ntrack = \"track.csv\"\nexclude = -1\n"), {"study.toml:5", "from 0"});
  EXPECT_EQ(read_with("[[experiment]]\nvideo = \"flight.mkv\"\n").experiments[0].video->filename(), "flight.mkv");
}

TEST_F(Experiments, ValidationHasThreeForms) {
  const std::string head = "[[experiment]]\ntrack = \"track.csv\"\nvalidation = ";
  EXPECT_EQ(read_with("[[experiment]]\ntrack = \"track.csv\"\n").experiments[0].validation, ExperimentStudy::Validation::none);
  EXPECT_DOUBLE_EQ(read_with(head + "\"last 12.5%\"").experiments[0].fraction, 0.125);
  const std::vector<ExperimentStudy> two = read_with(head + "\"other.csv\"\nname = \"flight\"\nexclude = 3\n").experiments;
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[1].track->filename(), "other.csv");
  EXPECT_EQ(two[1].name, "flight validation");
  EXPECT_EQ(two[1].exclude, 3);
  EXPECT_LT(two[1].from, -1e9);
  EXPECT_GT(two[1].to, 1e9);
  for (const char* wrong : {"\"first 25 %\"", "\"last 25\"", "\"last -5 %\"", "25", "true"}) {
    expect_parts(error_with(head + wrong), {"study.toml:5", "\"last 25 %\", [t0, t1] in seconds, or a file (.csv, .mat, .ulg"});
  }
  for (const char* wrong : {"\"last 0 %\"", "\"last 100 %\""}) expect_parts(error_with(head + wrong), {"study.toml:5", "above 0 %"});
  for (const char* wrong : {"[1]", "[2, 1]", "[1, 1]", "[1, 2, 3]"}) expect_parts(error_with(head + wrong), {"study.toml:5", "two times"});
  expect_parts(error_with(head + "[1, \"2 m\"]"), {"study.toml:5", "'m'", "'s'"});
}

}  // namespace
}  // namespace misfit
