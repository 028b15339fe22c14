// Runs that follow a run: what is done again and what is not, the same study twice, resolved.toml, interruption.

#include <sys/stat.h>

#include <cmath>
#include <csignal>
#include <map>
#include <thread>

#include "tests/apps/program.h"

namespace {

using namespace program;

/// Seconds of every stage: they change only when the stage runs.
std::map<std::string, double> seconds_of(const StudyCopy& study) {
  std::map<std::string, double> seconds;
  const json run = study.result("run.json");
  for (const auto& [name, stage] : run.at("stages").items()) seconds[name] = stage.at("seconds").get<double>();
  return seconds;
}

std::map<std::string, fs::file_time_type> times_of(const StudyCopy& study) {
  std::map<std::string, fs::file_time_type> times;
  for (const auto& entry : fs::recursive_directory_iterator(study.out("")))
    if (entry.is_regular_file()) times[entry.path().string()] = entry.last_write_time();
  return times;
}

std::vector<std::string> changed_stages(const std::map<std::string, double>& before, const std::map<std::string, double>& after) {
  std::vector<std::string> changed;
  for (const auto& [name, seconds] : after)
    if (!before.contains(name) || before.at(name) != seconds) changed.push_back(name);
  return changed;
}

using Names = std::vector<std::string>;

TEST(RunAgain, DoesNothingWhenNothingChanged) {
  const StudyCopy study("mpf_f111");
  study.start_from_track();
  const Outcome first = study.run();
  const auto seconds = seconds_of(study);
  const auto times = times_of(study);
  const Outcome second = study.run();
  EXPECT_EQ(second.status, 0) << second.err;
  EXPECT_EQ(changed_stages(seconds, seconds_of(study)), Names{});
  EXPECT_EQ(times, times_of(study));
  EXPECT_EQ(first.out, second.out);
  EXPECT_LT(second.seconds, 0.5 * first.seconds);
}

class RunAgainOnValidation : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(study.run().status, 0);
    before = seconds_of(study);
  }
  Names changed() {
    const Outcome outcome = study.run();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return changed_stages(before, seconds_of(study));
  }
  const StudyCopy study{"validation"};
  std::map<std::string, double> before;
};

TEST_F(RunAgainOnValidation, AReferenceTouchesComparisonAndPageOnly) {
  study.change_rows("figure5.csv", [](std::size_t row, const auto& cells) {
    return row == 3 ? "5.7,0.0161" : cells[0] + "," + (cells.size() > 1 ? cells[1] : "");
  });
  EXPECT_EQ(changed(), (Names{"compare", "report"}));
}

TEST_F(RunAgainOnValidation, ASampleTouchesEveryFit) {
  study.change_rows("alpha_history.csv",
                    [](std::size_t row, const auto& c) { return c[0] + "," + (row == 9 ? "14.2" : c[1]) + "," + c[2]; });
  EXPECT_EQ(changed(), (Names{"compare", "fit/equation_error", "fit/output_error", "fit/sliding_bin", "report", "resolved"}));
}

TEST_F(RunAgainOnValidation, ADeletedResultIsMadeAgain) {
  for (const auto& [file, stages] : std::map<std::string, Names>{{"fit/sliding_bin/curves.csv", {"fit/sliding_bin"}},
                                                                 {"compare.json", {"compare"}},
                                                                 {"report.html", {"report"}},
                                                                 {"figures/curve_C_m.svg", {"report"}}}) {
    before = seconds_of(study);
    fs::remove(study.out(file));
    const Names again = changed();
    EXPECT_TRUE(fs::exists(study.out(file))) << file;
    EXPECT_NE(std::find(again.begin(), again.end(), stages.front()), again.end()) << file;
    EXPECT_EQ(std::find(again.begin(), again.end(), "fit/output_error"), again.end()) << file;
  }
  fs::remove(study.out("resolved.toml"));
  (void)changed();
  EXPECT_TRUE(fs::exists(study.out("resolved.toml")));
}

TEST_F(RunAgainOnValidation, ABrokenRunJsonMeansEverythingAgain) {
  std::ofstream(study.out("run.json")) << "{ broken";
  const Outcome outcome = study.run();
  EXPECT_EQ(outcome.status, 0);
  expect_parts(outcome.err, {"run.json", "run again"});
  EXPECT_EQ(changed_stages(before, seconds_of(study)).size(), before.size());
}

TEST(RunFromScratch, GivesTheSameBytesTwice) {
  const StudyCopy one("validation"), other("validation");
  ASSERT_EQ(one.run().status, 0);
  ASSERT_EQ(other.run("run", {"--threads", "1"}).status, 0);
  for (const char* method : {"sliding_bin", "equation_error", "output_error"}) {
    const std::string curves = std::string("fit/") + method + "/curves.csv";
    EXPECT_EQ(content(one.out(curves)), content(other.out(curves))) << method;
    json a = one.fit(method), b = other.fit(method);
    a.erase("seconds");
    b.erase("seconds");
    EXPECT_EQ(a.dump(), b.dump()) << method;
  }
}

/// The resolved study is run where it lies.
void expect_same_from_resolved(const StudyCopy& study) {
  ASSERT_EQ(study.run().status, 0);
  const Outcome again = program::run({"run", study.out("resolved.toml").string()});
  ASSERT_EQ(again.status, 0) << again.err << content(study.out("resolved.toml"));
  std::size_t compared = 0;
  for (const auto& entry : fs::directory_iterator(study.out("fit"))) {
    const std::string method = entry.path().filename().string(), curves = "fit/" + method + "/curves.csv";
    json a = study.fit(method), b = study.result("out/fit/" + method + "/fit.json");
    a.erase("seconds");
    b.erase("seconds");
    EXPECT_EQ(a.dump(), b.dump()) << method;
    if (fs::exists(study.out(curves))) {
      EXPECT_EQ(content(study.out(curves)), content(study.out("out/" + curves))) << method;
    }
    ++compared;
  }
  EXPECT_GT(compared, 0U);
}

TEST(ResolvedStudy, GivesTheSameResultsOnColumns) { expect_same_from_resolved(StudyCopy("validation")); }
TEST(ResolvedStudy, GivesTheSameResultsWithSharedStates) { expect_same_from_resolved(StudyCopy("cascaded_tanks")); }
TEST(ResolvedStudy, GivesTheSameResultsWithAUnitInAParameter) { expect_same_from_resolved(StudyCopy("single_pendulum")); }
TEST(ResolvedStudy, GivesTheSameResultsOnATrack) {
  const StudyCopy study("mpf_f111");
  study.start_from_track();
  expect_same_from_resolved(study);
}

TEST(ResolvedStudy, KeepsPriorsFreeConstantsFixedCurvesAndColumns) {
  const StudyCopy study("validation");
  study.change("m_a = \"0.294 kg\"", "m_a = { value = \"0.294 kg\", sigma = \"0.033 kg\" }");
  study.change("exclude.*|columns = (.*)", "columns = $1\nexclude = 7\nvalidation = \"last 25 %\"");
  study.append("[parameters]\nm_a = { free = true }\n[sliding_bin]\nwidth = \"2 deg\"\n");
  study.change("perturb = .*", "bootstrap = 7\nblock = 30\nprofile = [\"m_a\"]");
  ASSERT_EQ(study.run("fit").status, 0);
  const std::string text = content(study.out("resolved.toml"));
  expect_parts(text, {"m_a = { value = \"0.294 kg\", sigma = \"0.033 kg\" }", "free = true", "exclude = 7", "alpha_T = \"alpha_T\"",
                      "validation = [", "width = \"2 deg\"", "\nbootstrap = 7\n", "\nblock = 30\n", "\nprofile = [\"m_a\"]\n"});
  const Outcome again = program::run({"fit", study.out("resolved.toml").string()});
  ASSERT_EQ(again.status, 0) << again.err << text;
  const json a = study.fit("output_error"), b = study.result("out/fit/output_error/fit.json");
  EXPECT_EQ(a.at("parameters").size(), b.at("parameters").size());
  EXPECT_EQ(a.at("loglik"), b.at("loglik"));
}

/// A study of many recordings is slow enough to be caught at work.
TEST(Interruption, LeavesAFolderFromWhichTheNextRunGoesOn) {
  const StudyCopy study("validation");
  for (int i = 0; i < 4; ++i) {
    const std::string name = "history" + std::to_string(i);
    fs::copy_file(study.path("alpha_history.csv"), study.path(name + ".csv"));
    study.append("\n[[experiment]]\ndata = \"" + name + ".csv\"\n");
  }
  const TemporaryFolder captured;
  const pid_t child = start(captured.path(), {"run", study.path("study.toml").string()});
  const auto first_is_recorded = [&] {
    return fs::exists(study.out("run.json")) && content(study.out("run.json")).find("fit/sliding_bin") != std::string::npos;
  };
  for (int i = 0; i < 24'000 && !first_is_recorded(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_TRUE(first_is_recorded());
  ::kill(child, SIGINT);
  const Outcome interrupted = finish(captured.path(), child);
  EXPECT_EQ(interrupted.status, 1);
  expect_parts(interrupted.err, {"interrupted", "the same command continues"});
  EXPECT_FALSE(fs::exists(study.out("report.html")));
  const double seconds = seconds_of(study).at("fit/sliding_bin");
  const Outcome next = study.run();
  EXPECT_EQ(next.status, 0) << next.err;
  EXPECT_TRUE(fs::exists(study.out("report.html")));
  EXPECT_EQ(seconds_of(study).at("fit/sliding_bin"), seconds);
}

}  // namespace
