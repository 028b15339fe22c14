// Data that are broken, short, holed or at awkward places: an answer, or words that say why there is none.

#include <fmt/format.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>

#include "tests/apps/program.h"

namespace {

using namespace program;
using Cells = std::vector<std::string>;

void expect_refused(const StudyCopy& study, int status, std::initializer_list<const char*> expected) {
  const Outcome outcome = study.run();
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_EQ(outcome.out.find("Verdict"), std::string::npos) << outcome.out;
  expect_parts(outcome.err, expected);
  EXPECT_FALSE(fs::exists(study.out("report.html")));
}

TEST(BrokenTable, EmptyOrWithoutRows) {
  const StudyCopy study("validation");
  study.write("alpha_history.csv", "");
  expect_refused(study, 2, {"alpha_history.csv", "no header"});
  study.write("alpha_history.csv", "t[s],alpha_T[deg]\n");
  expect_refused(study, 2, {"alpha_history.csv", "no rows"});
}

TEST(BrokenTable, AColumnThatIsNotThere) {
  const StudyCopy study("validation");
  study.write("alpha_history.csv", "t[s],alfa_T[deg]\n0,1\n0.1,2\n");
  expect_refused(study, 2, {"alpha_history.csv", "'alpha_T'", "'alfa_T[deg]'"});
}

TEST(BrokenTable, AColumnWithTheWrongUnit) {
  const StudyCopy study("validation");
  study.write("alpha_history.csv", "t[s],alpha_T[kg]\n0,1\n0.1,2\n");
  expect_refused(study, 2, {"alpha_history.csv", "alpha_T", "kg", "rad"});
}

TEST(BrokenTable, TextInANumberColumn) {
  const StudyCopy study("validation");
  study.change_rows("alpha_history.csv",
                    [](std::size_t row, const Cells& c) { return c[0] + "," + (row == 7 ? "abc" : c[1]) + "," + c[2]; });
  expect_refused(study, 2, {"alpha_history.csv:8", "'alpha_T[deg]'", "'abc'"});
}

TEST(BrokenTable, TimeThatRunsBackwards) {
  const StudyCopy study("validation");
  study.change_rows("alpha_history.csv",
                    [](std::size_t row, const Cells& c) { return (row == 7 ? "0.01" : c[0]) + "," + c[1] + "," + c[2]; });
  expect_refused(study, 2, {"alpha_history.csv:8", "time does not increase", "0.01 s"});
}

TEST(BrokenTable, EverySampleLost) {
  const StudyCopy study("validation");
  study.change_rows("alpha_history.csv", [](std::size_t, const Cells& c) { return c[0] + ",,"; });
  expect_refused(study, 2, {"alpha_history.csv:2", "'alpha_T'", "'history'", "no value at all"});
}

TEST(BrokenTable, ASweepOfTwoPoints) {
  const StudyCopy study("mpf_f111");
  study.start_from_track();
  study.change_rows("static_sweep.csv", [](std::size_t row, const Cells& c) {
    std::string line;
    for (const auto& cell : c) line += (line.empty() ? "" : ",") + cell;
    return row <= 2 ? line : "";
  });
  expect_refused(study, 1, {"sweep", "2 different angles", "at least three"});
}

TEST(FewSamples, TwentyAreAnsweredInWords) {
  const StudyCopy study("validation");
  study.change_rows("alpha_history.csv", [](std::size_t row, const Cells& c) { return row <= 20 ? c[0] + "," + c[1] + "," + c[2] : ""; });
  expect_refused(study, 1, {"samples show its quantity", "at least 60"});
}

TEST(NothingToEstimate, EveryParameterFixedIsAnsweredInWords) {
  const StudyCopy study("validation");
  study.change("C_m = \\{ of = \"alpha_T\" \\}", "C_m = { of = \"alpha_T\", table = \"figure5.csv\" }");
  study.change("C_m_alphadot = \\{ of = \"alpha_T\" \\}", "C_m_alphadot = { of = \"alpha_T\", table = \"damping.csv\" }");
  study.append("[parameters]\nC_m = { free = false }\nC_m_alphadot = { free = false }\n");
  const Outcome outcome = study.run("run", {"--method", "output_error", "--method", "equation_error"});
  EXPECT_EQ(outcome.status, 1) << outcome.out << outcome.err;
  expect_parts(outcome.out + outcome.err, {"every parameter is fixed"});
}

TEST(HoledData, FortyPercentOfTheAnglesMissingStillGiveTheTrim) {
  const StudyCopy study("validation");
  std::size_t lost = 0;
  study.change_rows("alpha_history.csv", [&](std::size_t row, const Cells& c) {
    const bool gone = (row * 7919) % 10 < 4;
    lost += gone ? 1 : 0;
    return gone ? c[0] + ",," : c[0] + "," + c[1] + "," + c[2];
  });
  EXPECT_GT(lost, 1800U);
  ASSERT_EQ(study.run().status, 0);
  const json fit = study.fit("output_error");
  EXPECT_EQ(fit.at("status"), "converged");
  EXPECT_NEAR(fit.at("trim_deg").at("value").get<double>(), 12.0, 3.0 * fit.at("trim_deg").at("sigma").get<double>());
  EXPECT_EQ(study.fit("sliding_bin").at("status"), "declined");  // no stencil of it has all its samples
}

TEST(HoledData, AHoleInTheTrackIsCarriedToTheAttitude) {
  const StudyCopy study("mpf_f111");
  study.start_from_track();
  study.change_rows("track.csv", [](std::size_t, const Cells& c) {
    const double t = std::stod(c[0]);
    return c[0] + (t > 20.0 && t < 23.0 ? ",," : "," + c[1] + "," + c[2]);
  });
  const Outcome outcome = study.run("run", {"--method", "sliding_bin", "--method", "equation_error"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::istringstream lines(content(study.out("attitude.csv")));
  std::string line;
  std::size_t rows = 0, empty = 0;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    ++rows;
    const double t = std::stod(line);
    if (t <= 20.0 || t >= 23.0) continue;
    EXPECT_NE(line.find(",,,,,,"), std::string::npos) << line;
    ++empty;
  }
  EXPECT_EQ(rows, 4761U);
  EXPECT_GT(empty, 170U);
  expect_parts(outcome.out, {fmt::format("{} of 4761 samples read", rows - empty).c_str()});
}

TEST(Outliers, ManyWildMeasurementsAreAnswered) {
  const StudyCopy study("validation");
  study.change_rows("alpha_history.csv", [](std::size_t row, const Cells& c) {
    return c[0] + "," + (row % 97 == 0 ? std::to_string(std::stod(c[1]) + 40.0) : c[1]) + "," + c[2];
  });
  const Outcome outcome = study.run();
  EXPECT_TRUE(outcome.status == 0 || outcome.status == 1) << outcome.err;
  const json fit = study.fit("output_error");
  if (fit.at("status") == "converged") {
    EXPECT_NEAR(fit.at("trim_deg").at("value").get<double>(), 12.0, 3.0 * fit.at("trim_deg").at("sigma").get<double>());
  } else {
    EXPECT_FALSE(fit.at("message").get<std::string>().empty());
  }
}

/// Exact zeros among the angles: square roots and arc tangents have no derivative there.
TEST(AlphaExactlyZero, AmongTheSamplesIsAnswered) {
  const StudyCopy study("validation");
  study.change_rows("alpha_history.csv",
                    [](std::size_t row, const Cells& c) { return c[0] + "," + (row % 500 == 0 ? "0" : c[1]) + "," + c[2]; });
  const Outcome outcome = study.run();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const json regression = study.fit("equation_error");
  EXPECT_EQ(regression.at("status"), "converged");
  EXPECT_NEAR(regression.at("trim_deg").at("value").get<double>(), 12.0, 0.5);
}

TEST(AlphaExactlyZero, ThroughoutSaysThatNothingMoves) {
  const StudyCopy study("validation");
  study.change_rows("alpha_history.csv", [](std::size_t, const Cells& c) { return c[0] + ",0,0"; });
  expect_refused(study, 1, {"C_m", "does not move"});
}

TEST(AlphaExactlyZero, AnApexThatRestsOnTheAxisIsReadAndRefusedInWords) {
  const StudyCopy study("mpf_f111");
  study.start_from_track();
  study.change(R"(sweep.*\nmodel.*)", "model = \"pinhole\"\nh_c = 0\nK = \"133.8 px/m\"");
  study.change_rows("track.csv", [](std::size_t row, const Cells& c) { return row <= 500 ? c[0] + ",0,0" : ""; });
  const Outcome attitude = study.run("attitude");
  ASSERT_EQ(attitude.status, 0) << attitude.err;
  EXPECT_EQ(content(study.out("attitude.csv")).find("nan"), std::string::npos);
  expect_refused(study, 1, {"'flight'", "phi_rate", "no value"});  // on the axis no clock angle exists
}

constexpr int not_possible_here = 77;

/// A run folder on a disk of 64 kB. The mount ends with the child process, and the files with it.
TEST(FullDisk, IsNamedAndLeavesNoHalfWrittenFile) {
  const StudyCopy study("validation");
  fs::create_directory(study.path("small"));
  const Outcome outcome = study.run();
  ASSERT_EQ(outcome.status, 0);
  const std::string small = study.path("small").string();
  const Outcome full = program::run({"run", study.path("study.toml").string(), "--out", small}, [&] {
    if (::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) ::_exit(not_possible_here);
    (void)::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
    if (::mount("tmpfs", small.c_str(), "tmpfs", 0, "size=64k") != 0) ::_exit(not_possible_here);
  });
  if (full.status == not_possible_here)
    GTEST_SKIP() << "no small file system can be mounted here; the next test writes against a limit instead";
  EXPECT_EQ(full.status, 1) << full.out << full.err;
  expect_parts(full.err, {"No space left on device"});
  for (const char* of_the_end : {"Verdict", "report:", "output_error"})
    EXPECT_EQ(full.out.find(of_the_end), std::string::npos) << "only stages that have ended say so\n" << full.out;
}

TEST(FullDisk, AFileSizeLimitLeavesWholeFilesOnlyAndTheNextRunGoesOn) {
  const StudyCopy study("validation");
  const Outcome full = program::run({"run", study.path("study.toml").string()}, [] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{65536, 65536};
    if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) ::_exit(not_possible_here);
  });
  EXPECT_EQ(full.status, 1) << full.out << full.err;
  expect_parts(full.err, {"File too large", "cannot be written"});
  for (const auto& entry : fs::recursive_directory_iterator(study.out(""))) {
    if (entry.path().extension() == ".json") {
      EXPECT_TRUE(json::accept(content(entry.path()))) << entry.path();
    }
    EXPECT_EQ(entry.path().filename().string().find(".tmp"), std::string::npos) << entry.path();
  }
  const Outcome next = study.run();
  EXPECT_EQ(next.status, 0) << next.err;
  EXPECT_TRUE(fs::exists(study.out("report.html")));
}

}  // namespace
