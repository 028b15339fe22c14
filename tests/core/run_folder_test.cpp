#include "misfit/core/run_folder.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/version.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

using Inputs = std::map<std::string, std::string>;
const Inputs inputs{{"track.csv", "0123"}, {"settings", "4567"}};

/// A run folder in which `calibrate` has run and left camera.json.
class RanBefore : public ::testing::Test {
 protected:
  RanBefore() {
    RunFolder run(out(), "misfit calibrate study.toml", 7);
    write_atomically(run.file("camera.json"), "{}");
    run.record({"calibrate", "misfit calibrate study.toml", inputs, {"camera.json"}, 1.5});
  }
  std::filesystem::path out() const { return folder_.path() / "out"; }
  bool up_to_date(const Inputs& now) const { return RunFolder(out(), "misfit run study.toml", 7).up_to_date("calibrate", now); }
  void edit(const std::function<void(nlohmann::json&)>& change) const {
    nlohmann::json run = nlohmann::json::parse(read_file(out() / "run.json"));
    change(run);
    write_atomically(out() / "run.json", run.dump());
  }
  TemporaryFolder folder_;
};

TEST(RunFolderMade, GoesIfNothingWasPutIntoIt) {
  const TemporaryFolder folder;
  const std::filesystem::path made = folder.path() / "made", there = folder.path() / "there", used = folder.path() / "used";
  std::filesystem::create_directory(there);
  {
    const RunFolder one(made, "misfit fit study.toml", 7), two(there, "misfit fit study.toml", 7), three(used, "misfit fit study.toml", 7);
    EXPECT_TRUE(std::filesystem::is_directory(made));
    write_atomically(used / "camera.json", "{}");
  }
  EXPECT_FALSE(std::filesystem::exists(made));
  EXPECT_TRUE(std::filesystem::exists(there)) << "it was there before";
  EXPECT_TRUE(std::filesystem::exists(used / "camera.json"));
}

TEST_F(RanBefore, ASecondRunIsUpToDate) { EXPECT_TRUE(up_to_date(inputs)); }

TEST_F(RanBefore, AnotherStageIsNot) { EXPECT_FALSE(RunFolder(out(), "", 7).up_to_date("attitude", inputs)); }

TEST_F(RanBefore, AChangedAddedOrRemovedInputIsNot) {
  EXPECT_FALSE(up_to_date({{"track.csv", "9999"}, {"settings", "4567"}}));
  EXPECT_FALSE(up_to_date({{"track.csv", "0123"}, {"settings", "4567"}, {"sweep.csv", "1"}}));
  EXPECT_FALSE(up_to_date({{"track.csv", "0123"}}));
}

TEST_F(RanBefore, ADeletedOutputIsNot) {
  std::filesystem::remove(out() / "camera.json");
  EXPECT_FALSE(up_to_date(inputs));
}

TEST_F(RanBefore, AnotherProgramIsNotEvenAfterOneOfItsStagesIsRecorded) {
  edit([](nlohmann::json& run) { run["stages"]["calibrate"]["commit"] = "another"; });
  EXPECT_FALSE(up_to_date(inputs));
  RunFolder(out(), "", 7).record({"attitude", "", {}, {}, 0.0});
  EXPECT_FALSE(up_to_date(inputs));
}

TEST_F(RanBefore, RunJsonHasTheContractsKeys) {
  const nlohmann::json run = nlohmann::json::parse(read_file(out() / "run.json"));
  EXPECT_EQ(run["version"], version());
  EXPECT_EQ(run["commit"], commit());
  EXPECT_EQ(run["seed"], 7);
  EXPECT_EQ(run["command"], "misfit calibrate study.toml");
  const nlohmann::json& stage = run["stages"]["calibrate"];
  EXPECT_EQ(stage["command"], "misfit calibrate study.toml");
  EXPECT_EQ(stage["inputs"]["track.csv"], "0123");
  EXPECT_EQ(stage["outputs"], nlohmann::json({"camera.json"}));
  EXPECT_EQ(stage["seconds"], 1.5);
}

TEST_F(RanBefore, ATornRunJsonCountsAsAbsentAndIsSaid) {
  const std::string whole = read_file(out() / "run.json");
  for (const std::string& torn :
       {std::string(), whole.substr(0, whole.size() / 2), std::string("[1, 2]"), std::string("{\"stages\": {\"calibrate\": 3}}")}) {
    folder_.write("out/run.json", torn);
    ::testing::internal::CaptureStderr();
    EXPECT_FALSE(up_to_date(inputs)) << torn;
    EXPECT_NE(::testing::internal::GetCapturedStderr().find("run.json"), std::string::npos) << torn;
  }
}

TEST_F(RanBefore, AfterATornRunJsonStagesAreRecordedAgain) {
  folder_.write("out/run.json", "{");
  ::testing::internal::CaptureStderr();
  RunFolder run(out(), "", 7);
  (void)::testing::internal::GetCapturedStderr();
  run.record({"calibrate", "", inputs, {"camera.json"}, std::numeric_limits<double>::quiet_NaN()});
  EXPECT_TRUE(up_to_date(inputs));
}

TEST_F(RanBefore, EarlierStagesAreKept) {
  RunFolder(out(), "", 7).record({"attitude", "", inputs, {}, 0.0});
  EXPECT_TRUE(up_to_date(inputs));
  EXPECT_EQ(RunFolder(out(), "", 7).stages().size(), 2U);
}

TEST(RunFolder, KnowsWhoseResultsItHolds) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "out", first = folder.write("study.toml", ""), second = folder.write("other.toml", "");
  RunFolder(out, "", 1, first).record({"calibrate", "", inputs, {}, 0.0});
  EXPECT_EQ(nlohmann::json::parse(read_file(out / "run.json"))["study"], "../study.toml");
  EXPECT_FALSE(RunFolder(out, "", 1, first).other_study().has_value());
  EXPECT_EQ(RunFolder(out, "", 1, second).other_study(), first);
  std::filesystem::rename(first, folder.path() / "renamed.toml");
  EXPECT_FALSE(RunFolder(out, "", 1, folder.path() / "renamed.toml").other_study().has_value()) << "a study that was renamed";
}

TEST(RunFolder, BelowARegularFileIsRefused) {
  const TemporaryFolder folder;
  const auto file = folder.write("x", "");
  expect_parts(message_of<InputError>([&] { RunFolder(file / "out", "", 1); }), {"x/out", "Not a directory"});
}

}  // namespace
}  // namespace misfit
