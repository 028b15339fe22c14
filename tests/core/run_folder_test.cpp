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

/// Does a stage that leaves these files.
void leave(RunFolder& run, const std::string& stage, const Inputs& from, const std::map<std::string, std::string>& files,
           double seconds = 0.0) {
  const PartFolder part(run.path());
  for (const auto& [name, content] : files) {
    std::filesystem::create_directories((part.path() / name).parent_path());
    write_atomically(part.path() / name, content);
  }
  run.commit(part, {stage, "misfit calibrate study.toml", from, {}, seconds});
}

/// A run folder in which `calibrate` has run and left camera.json.
class RanBefore : public ::testing::Test {
 protected:
  RanBefore() {
    RunFolder run(out(), "misfit calibrate study.toml", 7);
    leave(run, "calibrate", inputs, {{"camera.json", "{}"}}, 1.5);
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
  {
    RunFolder run(out(), "", 7);
    leave(run, "attitude", {}, {});
  }
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
    const RunFolder run(out(), "", 7);
    EXPECT_FALSE(run.up_to_date("calibrate", inputs)) << torn;
    EXPECT_NE(run.lost_record().find("run.json"), std::string::npos) << torn;
  }
}

TEST_F(RanBefore, AfterATornRunJsonStagesAreRecordedAgain) {
  folder_.write("out/run.json", "{");
  ::testing::internal::CaptureStderr();
  {
    RunFolder run(out(), "", 7);
    (void)::testing::internal::GetCapturedStderr();
    leave(run, "calibrate", inputs, {{"camera.json", "{}"}}, std::numeric_limits<double>::quiet_NaN());
  }
  EXPECT_TRUE(up_to_date(inputs));
}

TEST_F(RanBefore, EarlierStagesAreKept) {
  {
    RunFolder run(out(), "", 7);
    leave(run, "attitude", inputs, {});
  }
  EXPECT_TRUE(up_to_date(inputs));
  EXPECT_EQ(RunFolder(out(), "", 7).stages().size(), 2U);
}

TEST_F(RanBefore, AnOutputThatWasEditedEmptiedOrReplacedByALinkIsNot) {
  const auto camera = out() / "camera.json";
  folder_.write("out/camera.json", "{ }");
  EXPECT_FALSE(up_to_date(inputs));
  EXPECT_EQ(RunFolder(out(), "", 7).damaged("calibrate"), std::vector<std::string>{"camera.json"});
  folder_.write("out/camera.json", "");
  EXPECT_FALSE(up_to_date(inputs));
  std::filesystem::remove(camera);
  std::filesystem::create_symlink(folder_.write("elsewhere", "{}"), camera);
  EXPECT_FALSE(up_to_date(inputs));
}

TEST_F(RanBefore, AStageDoneAgainWritesOverWhatItMadeAndRemovesWhatItMakesNoMore) {
  {
    RunFolder run(out(), "", 7);
    leave(run, "report", inputs, {{"figures/a.svg", "a"}, {"figures/b.svg", "b"}, {"figures/c.svg", "c"}});
    folder_.write("out/figures/c.svg", "edited since");
    folder_.write("out/figures/mine.pdf", "mine");
    leave(run, "report", inputs, {{"figures/a.svg", "new"}});
  }
  EXPECT_EQ(read_file(out() / "figures/a.svg"), "new");
  EXPECT_FALSE(std::filesystem::exists(out() / "figures/b.svg"));
  EXPECT_EQ(read_file(out() / "figures/c.svg"), "edited since");
  EXPECT_EQ(read_file(out() / "figures/mine.pdf"), "mine");
}

TEST_F(RanBefore, WhatAnotherStageMadeIsNotRemoved) {
  RunFolder run(out(), "", 7);
  leave(run, "uncertainty", inputs, {{"figures/bands.svg", "1"}});
  leave(run, "report", inputs, {{"figures/bands.svg", "2"}, {"report.html", ""}});
  leave(run, "report", inputs, {{"report.html", ""}});
  EXPECT_EQ(read_file(out() / "figures/bands.svg"), "2");
  EXPECT_TRUE(run.up_to_date("uncertainty", inputs)) << "the later content is the one that counts";
}

TEST_F(RanBefore, AFileThatMisfitDidNotMakeIsKeptAndNamed) {
  folder_.write("out/track.csv", "mine");
  RunFolder run(out(), "", 7);
  expect_parts(message_of<WriteError>([&] { run.check_places({"track.csv"}); }), {"track.csv", "--force", "--out"});
  expect_parts(message_of<WriteError>([&] { leave(run, "track", inputs, {{"track.csv", "x"}, {"track.json", "y"}}); }), {"track.csv"});
  EXPECT_EQ(read_file(out() / "track.csv"), "mine");
  EXPECT_FALSE(std::filesystem::exists(out() / "track.json")) << "all or nothing";
  EXPECT_FALSE(run.up_to_date("track", inputs));
}

TEST_F(RanBefore, WithForceItIsWrittenOverButNeverAnInputNorThroughALink) {
  const auto mine = folder_.write("out/track.csv", "mine"), data = folder_.write("out/data.csv", "data");
  const auto elsewhere = folder_.write("elsewhere", "text");
  std::filesystem::create_symlink(elsewhere, out() / "linked.csv");
  std::filesystem::create_hard_link(data, out() / "same.csv");
  std::filesystem::create_directory_symlink(folder_.path(), out() / "figures");
  RunFolder run(out(), "", 7, {}, {{data}, true});
  leave(run, "track", inputs, {{"track.csv", "new"}});
  EXPECT_EQ(read_file(mine), "new");
  for (const char* name : {"data.csv", "same.csv"})
    expect_parts(message_of<WriteError>([&] { leave(run, "fit", inputs, {{name, "x"}}); }), {name, "input", "--out"});
  for (const char* name : {"linked.csv", "figures/elsewhere"})
    expect_parts(message_of<WriteError>([&] { leave(run, "fit", inputs, {{name, "x"}}); }), {"is a link"});
  EXPECT_EQ(read_file(data), "data");
  EXPECT_EQ(read_file(elsewhere), "text");
}

TEST_F(RanBefore, AfterATornRunJsonItsFilesAreStillKnown) {
  folder_.write("out/run.json", "{");
  RunFolder run(out(), "", 7);
  expect_parts(run.lost_record(), {"run.json", "all stages run again"});
  EXPECT_NO_THROW(leave(run, "calibrate", inputs, {{"camera.json", "again"}}));
  EXPECT_EQ(read_file(out() / "camera.json"), "again");
}

TEST(RunFolder, ARunJsonThatIsNotOursIsKept) {
  const TemporaryFolder folder;
  const auto file = folder.write("run.json", "my notes");
  expect_parts(message_of<InputError>([&] { RunFolder(folder.path(), "", 1); }), {"run.json", "--force"});
  EXPECT_EQ(read_file(file), "my notes");
}

TEST(RunFolder, ARunJsonOfAnEarlierVersionNamesItsFilesButNotTheirContent) {
  const TemporaryFolder folder;
  folder.write("camera.json", "{}");
  const nlohmann::json stage = {{"command", ""}, {"inputs", Inputs()},   {"outputs", {"camera.json"}},
                                {"seconds", 1},  {"version", version()}, {"commit", commit()}};
  folder.write("run.json", nlohmann::json{{"stages", {{"calibrate", stage}}}}.dump());
  RunFolder run(folder.path(), "", 1);
  EXPECT_FALSE(run.up_to_date("calibrate", {}));
  EXPECT_NO_THROW(run.check_places({"camera.json"}));
}

TEST(RunFolder, IsHeldByOneProcessAtATimeAndLookedAtByAny) {
  const TemporaryFolder folder;
  const RunFolder run(folder.path() / "out", "", 1);
  expect_parts(message_of<RunError>([&] { RunFolder(folder.path() / "out", "", 1); }), {"another misfit is at work in", "out"});
  EXPECT_NO_THROW(RunFolder(folder.path() / "out", "", 1, {}, {}, RunFolder::Access::read));
}

TEST(RunFolder, WhatAnEndedProgramLeftIsRemovedByTheNext) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "out/.misfit-part/0/figures");
  folder.write("out/.misfit-part/0/figures/half.svg", "<svg");
  { const RunFolder run(folder.path() / "out", "", 1); }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "out"));
}

TEST(RunFolder, KnowsWhoseResultsItHolds) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "out", first = folder.write("study.toml", ""), second = folder.write("other.toml", "");
  {
    RunFolder run(out, "", 1, first);
    leave(run, "calibrate", inputs, {});
  }
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
