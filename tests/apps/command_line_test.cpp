// Verbs, options and exit statuses.

#include <cmath>
#include <set>

#include "apps/what_next.h"
#include "tests/apps/program.h"
#include "tests/paths.h"

namespace {

using namespace program;

TEST(CommandLine, VersionAndHelpAreAnswersNotErrors) {
  const Outcome version = run({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_TRUE(std::regex_search(version.out, std::regex(R"(^misfit \d+\.\d+\.\d+)"))) << version.out;
  const Outcome help = run({"--help"});
  EXPECT_EQ(help.status, 0);
  for (const char* verb : {"run", "calibrate", "attitude", "fit", "compare", "report", "simulate", "effects"})
    expect_parts(help.out, {verb});
  EXPECT_EQ(run({"fit", "--help"}).status, 0);
}

TEST(CommandLine, AMistakeIsNamedAndEndsWithTwo) {
  struct Case {
    std::vector<std::string> arguments;
    const char* named;
  };
  for (const auto& [arguments, named] : std::vector<Case>{{{"calibrat", "x"}, "did you mean 'calibrate'"},
                                                          {{"fti", "x"}, "did you mean 'fit'"},
                                                          {{"nonsense"}, "nonsense"},
                                                          {{"run"}, "study"},
                                                          {{"run", "--fast", "x"}, "--fast"},
                                                          {{"fit", "x", "--metod", "output_error"}, "did you mean '--method'"},
                                                          {{"fit", "x", "--metod=output_error"}, "did you mean '--method'"},
                                                          {{"fit", "x", "--method", "outputerror"}, "did you mean 'output_error'"},
                                                          {{"fit", "motor.csv"}, "motor.csv: no such file"},
                                                          {{"export", "x"}, "--to"},
                                                          {{"export", "x", "--to", "pyton"}, "did you mean 'python'"},
                                                          {{"run", "x", "--threads", "many"}, "--threads"},
                                                          {{"run", "x", "--method", "magic"}, "magic"},
                                                          {{"run", "x", "--seed", "-1"}, "--seed"},
                                                          {{"run", "/no/such/study.toml"}, "/no/such/study.toml"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << named;
    expect_parts(outcome.err, {named});
    EXPECT_EQ(outcome.out, "") << named;
  }
}

TEST(CommandLine, AFolderStandsForTheStudyInIt) {
  const StudyCopy study("validation");
  EXPECT_EQ(run({"fit", study.path("").string(), "--method", "sliding_bin"}).status, 0);
  EXPECT_TRUE(fs::exists(study.out("fit/sliding_bin/fit.json")));
  EXPECT_FALSE(fs::exists(study.out("fit/output_error")));
  const TemporaryFolder empty;
  const Outcome none = run({"run", empty.path().string()});
  EXPECT_EQ(none.status, 2);
  expect_parts(none.err, {"study.toml", "no such file"});
}

TEST(CommandLine, JsonIsTheOnlyThingOnStdout) {
  const StudyCopy study("mpf_f111");
  study.start_from_track();
  const std::vector<std::string> options{"--json", "--method", "sliding_bin", "--method", "equation_error"};
  for (const std::string verb : {"calibrate", "attitude", "fit", "compare", "report", "run"}) {
    const bool fits = verb != "calibrate" && verb != "attitude";
    const Outcome outcome = study.run(verb, fits ? options : std::vector<std::string>{"--json"});
    EXPECT_EQ(outcome.status, 0) << verb << outcome.err;
    EXPECT_TRUE(json::accept(outcome.out)) << verb << ": " << outcome.out.substr(0, 300);
  }
  EXPECT_EQ(json::parse(study.run("fit", options).out).at("sliding_bin").at("method"), "sliding_bin");
}

TEST(CommandLine, QuietPrintsNothingOnStderr) {
  const StudyCopy study("validation");
  const Outcome outcome = study.run("run", {"--quiet"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  expect_parts(outcome.out, {"report: "});
}

TEST(Effects, EveryOneHasFormulaSourceAndUnits) {
  const Outcome outcome = run({"effects", "--json"});
  ASSERT_EQ(outcome.status, 0);
  const json all = json::parse(outcome.out);
  const Outcome text = run({"effects", "--verbose"}), list = run({"effects"});
  std::set<std::string> names;
  for (const auto& effect : all) {
    const std::string name = effect.at("effect");
    names.insert(name);
    EXPECT_NE(("\n" + text.out).find("\n" + name + "\n"), std::string::npos) << name;
    EXPECT_NE(list.out.find("\n  " + name + " "), std::string::npos) << name;
    for (const char* key : {"formula", "symbols", "valid", "size", "source"})
      EXPECT_FALSE(effect.at(key).get<std::string>().empty()) << name;
    EXPECT_NE(effect.at("ports").get<std::string>().find('['), std::string::npos) << name;
    for (const auto& c : effect.at("coefficients")) EXPECT_FALSE(c.at("unit").get<std::string>().empty()) << name << " " << c.at("name");
  }
  // every effect file of models/ is registered, under the name of its file
  for (const auto& entry : fs::recursive_directory_iterator(paths::source() / "models")) {
    if (entry.path().extension() != ".cpp" || content(entry.path()).find("MISFIT_EFFECT(") == std::string::npos) continue;
    EXPECT_TRUE(names.contains(entry.path().stem().string())) << entry.path();
  }
  EXPECT_GE(names.size(), 10U);
}

TEST(Effects, OfAStudyAreThoseItNames) {
  const StudyCopy study("validation");
  const Outcome outcome = study.run("effects", {"--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::set<std::string> names;
  for (const auto& effect : json::parse(outcome.out)) names.insert(effect.at("effect").get<std::string>());
  EXPECT_EQ(names, (std::set<std::string>{"static_moment", "pitch_damping"}));
}

/// rows × columns of a CSV, header left out.
std::vector<std::vector<double>> rows_of(const fs::path& file) {
  std::istringstream lines(content(file));
  std::string line;
  std::vector<std::vector<double>> rows;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    rows.emplace_back();
    std::istringstream cells(line);
    std::string cell;
    while (std::getline(cells, cell, ',')) rows.back().push_back(cell.empty() ? std::nan("") : std::stod(cell));
  }
  return rows;
}

/// The study's own motion, made again from its curves: alpha_history.csv came from other code, with the damping stepping at 11 and 13 deg
/// sharp, which the ramps of this table have as their middles. The static table (0.5 deg apart, interpolated linearly) is 0.06 deg off as
/// well; the bound is the study's measurement noise.
TEST(Simulate, AsTheSectionSaysGivesTheMotionThatWasMadeElsewhere) {
  const StudyCopy study("validation");
  study.change("C_m = \\{ of = \"alpha_T\" \\}", "C_m = { of = \"alpha_T\", table = \"figure5.csv\" }");
  study.change("C_m_alphadot = \\{ of = \"alpha_T\" \\}", "C_m_alphadot = { of = \"alpha_T\", table = \"damping.csv\" }");
  std::string damping = "alpha_T[deg],C_m_alphadot[-]\n";
  for (int i = 0; i < 150; ++i) damping += std::to_string(5.05 + 0.1 * i) + (i >= 60 && i < 80 ? ",0.1\n" : ",-0.1\n");
  study.write("damping.csv", damping);
  study.append("[simulate]\nduration = \"3 s\"\nstep = 0.0166833\ninitial = { eta = \"16 deg\" }\n");
  const Outcome outcome = study.run("simulate");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto simulated = rows_of(study.out("simulation.csv")), truth = rows_of(study.path("alpha_history.csv"));
  ASSERT_EQ(simulated.size(), 180U);
  for (std::size_t i = 0; i < simulated.size(); ++i) EXPECT_NEAR(simulated[i][1], truth[i][2], 0.1) << "sample " << i;
}

/// P_z = l_b K (R n_z + h_c)/(l_s − R n_x): the first sample is the start itself, seen by the calibrated camera.
TEST(Simulate, SeesTheMotionThroughTheCalibratedCamera) {
  const StudyCopy study("null");
  study.write("c_m.csv", "alpha_T[deg],C_m[-]\n0,0.075\n6,0.037\n12,0\n18,-0.037\n24,-0.074\n30,-0.11\n");
  study.write("c_mq.csv", "alpha_T[deg],C_mq[-]\n0,-0.25\n10,-0.25\n20,-0.25\n30,-0.25\n");
  study.append(
      "\n[curves]\nC_m = { of = \"alpha_T\", table = \"c_m.csv\" }\nC_mq = { of = \"alpha_T\", table = \"c_mq.csv\" }\n"
      "[simulate]\nduration = \"1 s\"\nstep = 0.0166833\ninitial = { n_z = 0.2 }\n");
  const Outcome outcome = study.run("simulate");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json camera = study.result("camera.json");
  const double K = camera.at("K").at("value"), h_c = camera.at("h_c").at("value");
  const double n_x = std::sqrt(1.0 - 0.04), expected = 5.69 * K * (3.447 * 0.2 + h_c) / (5.61 - 3.447 * n_x);
  const auto rows = rows_of(study.out("simulation.csv"));
  ASSERT_EQ(rows.size(), 60U);
  EXPECT_GT(K, 2.0) << "as calibrated, not the default";
  EXPECT_NEAR(rows[0][2], expected, 1e-3 * expected);
}

TEST(Simulate, AfterAFitFollowsTheMeasuredMotion) {
  const StudyCopy study("validation");
  const Outcome outcome = study.run("simulate", {"--method", "output_error", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out).at("samples"), 4761);
  EXPECT_EQ(rows_of(study.out("simulation.csv")).size(), 4761U);
}

TEST(Simulate, WithoutTablesSaysWhatIsMissing) {
  const StudyCopy study("validation");
  study.append("[simulate]\nduration = 1\n");
  const Outcome outcome = study.run("simulate");
  EXPECT_EQ(outcome.status, 2);
  expect_parts(outcome.err, {"study.toml", "C_m", "table"});
}

TEST(CommandLine, ARecordingIsNoStudyAndIsSaidToBeOneOnlyWhereItIs) {
  const TemporaryFolder folder;
  const std::string data = folder.write("motor.csv", "t[s],u[V]\n0,1\n").string();
  expect_parts(run({"discover", data}).err, {("misfit init " + data).c_str()});
  expect_parts(run({"discover", data + "2.csv"}).err, {"no such file"});
}

TEST(CommandLine, OfAFolderOfStudiesSaysWhatTheyHaveComeToAndWhatIsNext) {
  const TemporaryFolder folder;
  for (const char* name : {"done", "begun"}) {
    fs::create_directories(folder.path() / name / "out");
    folder.write(std::string(name) + "/study.toml", "");
  }
  folder.write("done/out/verdict.json", R"({"sentence": "nothing is found missing."})");
  for (const char* table : {"done.csv", "new.csv"}) folder.write(table, "");
  const std::string words = misfit::what_next(folder.path(), {});
  expect_parts(words, {"done: nothing is found missing.", "report: done/out/report.html", "misfit run begun", "misfit init new.csv"});
  for (const char* not_again : {"misfit run done", "misfit init done.csv"}) EXPECT_EQ(words.find(not_again), std::string::npos) << words;
}

}  // namespace
