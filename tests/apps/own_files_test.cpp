// What is the user's stays the user's: files in the run folder that misfit did not make, links, inputs.

#include <gmock/gmock.h>

#include <array>
#include <thread>

#include "tests/apps/oscillator_study.h"

namespace {

using namespace program;
using testing::HasSubstr;

/// One thing of the user's that stands where a verb writes, or near it.
struct Attack {
  std::string name;
  std::string verb;
  std::vector<std::string> options;
  std::string mine;        ///< file of the user, relative to the study, with the content "mine"
  std::string link;        ///< a link to it (or to its folder, if that ends in /), if not empty
  bool goes = true;        ///< the verb does its work all the same
  std::string words = {};  ///< of the refusal
};

void PrintTo(const Attack& attack, std::ostream* out) { *out << attack.name; }

class OwnFiles : public testing::TestWithParam<Attack> {};

TEST_P(OwnFiles, AreAsTheyWere) {
  const Attack& attack = GetParam();
  const OscillatorStudy study;
  const fs::path mine = study.path(attack.mine);
  fs::create_directories(mine.parent_path());
  study.write(attack.mine, "mine");
  if (!attack.link.empty()) {
    const bool folder = attack.link.ends_with('/');
    const fs::path link = study.path(folder ? attack.link.substr(0, attack.link.size() - 1) : attack.link);
    fs::create_directories(link.parent_path());
    fs::create_symlink(folder ? mine.parent_path() : mine, link);
  }
  std::vector<std::string> words{attack.verb, attack.verb == "init" ? study.path("d.csv").string() : study.path("").string()};
  for (std::string option : attack.options) {
    if (option.starts_with("@")) option = study.path(option.substr(1)).string();
    words.push_back(option);
  }
  const std::string data = content(study.path("d.csv"));
  const Outcome outcome = program::run(words);
  EXPECT_EQ(content(mine), "mine");
  EXPECT_EQ(content(study.path("d.csv")), data);
  EXPECT_EQ(outcome.status == 0, attack.goes) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(attack.words));
  for (const auto& entry : fs::recursive_directory_iterator(study.path(""))) EXPECT_NE(entry.path().filename(), ".misfit-part");
}

const std::vector<Attack> attacks{
    {"APdfInFigures", "run", {"--out", "@"}, "figures/mine.pdf", ""},
    {"AFolderBelowFigures", "run", {"--out", "@"}, "figures/thesis/chapter.tex", ""},
    {"APictureInFigures", "run", {}, "out/figures/mine.png", ""},
    {"AFigureOfTheSameName", "run", {}, "out/figures/motion_output_error_steps_y.svg", "", false, "motion_output_error_steps_y.svg"},
    {"AReport", "run", {}, "out/report.html", "", false, "report.html is there already"},
    {"AComparison", "compare", {}, "out/compare.json", "", false, "compare.json is there already"},
    {"AResult", "fit", {}, "out/fit/output_error/fit.json", "", false, "fit.json is there already"},
    {"AResolvedStudy", "fit", {}, "out/resolved.toml", "", false, "resolved.toml is there already"},
    {"ATextBesideAResult", "fit", {}, "out/fit/output_error/mine.txt", ""},
    {"ADiagnosis", "diagnose", {}, "out/missing_force.csv", "", false, "missing_force.csv is there already"},
    {"Candidates", "discover", {}, "out/candidates.json", "", false, "candidates.json is there already"},
    {"ALadder", "add", {"coulomb_friction"}, "out/ladder.json", "", false, "ladder.json is there already"},
    {"ATextInARung", "add", {"coulomb_friction"}, "out/rungs/01_coulomb_friction/mine.txt", ""},
    {"AStudyInARung", "add", {"coulomb_friction"}, "out/rungs/01_coulomb_friction/study.toml", "", false, "study.toml is there already"},
    {"ABootstrap", "uncertainty", {}, "out/bootstrap.json", "", false, "bootstrap.json is there already"},
    {"AFileForACheckpoint",
     "uncertainty",
     {},
     "out/bootstrap_output_error/checkpoint_0.bin",
     "",
     false,
     "checkpoint_0.bin is there already"},
    {"ACheckpointThatIsALink", "uncertainty", {}, "victim", "out/bootstrap_output_error/checkpoint_0.bin", false, "is a link"},
    {"CheckpointsInALinkedFolder", "uncertainty", {}, "elsewhere/mine", "out/bootstrap_output_error/", false, "is a link"},
    {"LinkedFigures", "run", {}, "elsewhere/paper.tex", "out/figures/", false, "is a link"},
    {"LinkedFits", "run", {}, "elsewhere/paper.tex", "out/fit/", false, "is a link"},
    {"LinkedRungs", "add", {"coulomb_friction"}, "elsewhere/paper.tex", "out/rungs/", false, "is a link"},
    {"ALinkedResult", "fit", {}, "victim", "out/fit/output_error/fit.json", false, "is a link"},
    {"ALinkedResultWithForce", "fit", {"--force"}, "victim", "out/fit/output_error/fit.json", false, "is a link"},
    {"ALinkedRunJson", "fit", {}, "victim", "out/run.json", false, "run.json"},
    {"ALinkForTheHiddenFolder", "fit", {}, "elsewhere/mine", "out/.misfit-part/"},
    {"ALinkedRunFolder", "fit", {}, "elsewhere/mine", "out/"},
    {"ADrawingLogThatIsALink", "run", {}, "victim", "out/figures/.motion_output_error_steps_y.log"},
    {"ARunJsonOfAnotherProgram", "fit", {}, "out/run.json", "", false, "--force"},
    {"ASimulation", "simulate", {}, "out/simulation.csv", "", false, "simulation.csv is there already"},
    {"ABatchTable", "batch", {}, "batch/batch.csv", "", false, "batch.csv is there already"},
    {"ATextBesideABatch", "batch", {}, "batch/mine.txt", ""},
    {"InitOverAStudy", "init", {"--out", "@new"}, "new/study.toml", "", false, "study.toml is there already"},
    {"InitOverAModel", "init", {"--out", "@new"}, "new/model.toml", "", false, "model.toml is there already"},
    {"InitOverOtherData", "init", {"--out", "@new"}, "new/d.csv", "", false, "d.csv is there already"},
    {"InitBesideOtherFigures", "init", {"--out", "@new"}, "new/figures/mine.svg", ""},
    {"InitIntoTheFolderOfItsData", "init", {"--out", "@"}, "mine", "", false, "is there already"},
    {"InitOverItsDataWithForce", "init", {"--out", "@", "--force"}, "mine", "", false, "is an input"},
    {"InitThroughALink", "init", {"--out", "@new"}, "victim", "new/study.toml", false, "is a link"},
    {"InitThroughALinkWithForce", "init", {"--out", "@new", "--force"}, "victim", "new/model.toml", false, "is a link"},
};

INSTANTIATE_TEST_SUITE_P(OfTheUser, OwnFiles, testing::ValuesIn(attacks), [](const auto& entry) { return entry.param.name; });

TEST(OwnFilesWithForce, AreWrittenOverAsTheUserSaid) {
  const OscillatorStudy study;
  fs::create_directories(study.path("out/fit/output_error"));
  study.write("out/fit/output_error/fit.json", "mine");
  const Outcome outcome = program::run({"fit", study.path("").string(), "--force"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(json::parse(content(study.path("out/fit/output_error/fit.json"))).at("method"), "output_error");
}

TEST(TwoRunsInOneFolder, AreKeptApart) {
  const OscillatorStudy study;
  const TemporaryFolder first, second;
  const std::vector<std::string> words = study.command("run", study.path("out"));
  const pid_t one = start(first.path(), words);
  std::this_thread::sleep_for(std::chrono::milliseconds(150));
  const pid_t two = start(second.path(), words);
  const Outcome a = finish(first.path(), one), b = finish(second.path(), two);
  EXPECT_TRUE(a.status == 0 || b.status == 0) << a.err << b.err;
  for (const Outcome& outcome : {a, b}) {
    EXPECT_TRUE(outcome.status == 0 || outcome.err.find("another misfit is at work in") != std::string::npos) << outcome.err;
  }
  EXPECT_TRUE(fs::exists(study.path("out/report.html")));
}

/// What is read from the run folder is what misfit wrote there, or it is made again.
TEST(DamagedResult, IsMadeAgainAndSaid) {
  const OscillatorStudy study;
  const std::vector<std::string> words{"run", study.path("").string()};
  ASSERT_EQ(program::run(words).status, 0);
  const auto whole = results_in(study.path("out"));
  enum class Damage { empty, cut_short, altered };
  const auto repairs = [&](const std::string& name, Damage damage) {
    const fs::path file = study.path("out") / name;
    std::string text = content(file);
    ASSERT_FALSE(text.empty()) << name;
    char& middle = text[text.size() / 2];
    middle = middle == '1' ? '2' : '1';
    if (damage != Damage::altered) text.resize(damage == Damage::empty ? 0 : text.size() / 2);
    std::ofstream(file, std::ios::binary | std::ios::trunc) << text;
    const Outcome again = program::run(words);
    EXPECT_EQ(again.status, 0) << name << ": " << again.err;
    EXPECT_THAT(again.err, HasSubstr("again")) << name;
    EXPECT_TRUE(differences(whole, results_in(study.path("out"))).empty()) << name;
  };
  constexpr std::array kinds = {Damage::empty, Damage::cut_short, Damage::altered};
  for (const Damage damage : kinds) repairs("run.json", damage);
  int next = 0;
  for (const char* name :
       {"resolved.toml", "report.html", "compare.json", "candidates.json", "discovery.json", "diagnosis.json", "missing_force.csv",
        "fit/output_error/fit.json", "fit/filter_error/prediction.csv", "figures/motion_output_error_steps_y.svg"})
    repairs(name, kinds[next++ % kinds.size()]);
}

}  // namespace
