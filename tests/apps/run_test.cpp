// `misfit run` on the shipped studies: the files and names that others rely on, and the numbers that are known.

#include <algorithm>
#include <cmath>

#include "tests/apps/oscillator_study.h"
#include "tests/apps/program.h"
#include "tests/report/html_faults.h"

namespace {

using namespace program;
using misfit::report::html_faults;

void expect_contract_of_fit(const StudyCopy& study, const std::string& method) {
  const json fit = study.fit(method);
  for (const char* key : {"method", "status", "message", "parameters", "noise", "force", "loglik", "validation_loglik", "trim_deg", "rms",
                          "validation_rms", "seconds", "linearisations"})
    EXPECT_TRUE(fit.contains(key)) << method << ": " << key;
  EXPECT_EQ(fit.at("method"), method);
  for (const auto& [name, p] : fit.at("parameters").items())
    EXPECT_TRUE(p.contains("value") && p.contains("sigma") && p.contains("unit")) << method << ": " << name;
}

/// run.json, resolved.toml, compare.json, the page, and every figure with its table and script; no JSON holds nan or inf.
void expect_contract_of_run(const StudyCopy& study) {
  const json run = study.result("run.json");
  for (const char* key : {"version", "commit", "seed", "stages"}) EXPECT_TRUE(run.contains(key)) << key;
  for (const auto& [name, stage] : run.at("stages").items()) {
    EXPECT_TRUE(stage.contains("command") && stage.contains("inputs") && stage.contains("seconds")) << name;
    for (const auto& output : stage.at("outputs")) EXPECT_TRUE(fs::exists(study.out(output))) << name << ": " << output;
  }
  EXPECT_FALSE(content(study.out("resolved.toml")).empty());
  EXPECT_EQ(study.result("compare.json").at("methods").size(), 3U);
  EXPECT_NE(content(study.out("report.html")).find("<svg"), std::string::npos);
  std::size_t figures = 0;
  for (const auto& entry : fs::directory_iterator(study.out("figures"))) {
    if (entry.path().extension() != ".svg") continue;
    ++figures;
    for (const char* other : {".csv", ".gp"}) EXPECT_TRUE(fs::exists(fs::path(entry.path()).replace_extension(other))) << entry.path();
  }
  EXPECT_GE(figures, 5U);
  const std::regex not_a_number(R"([:\[,]\s*-?(nan|NaN|inf|Infinity)\b)");
  for (const auto& entry : fs::recursive_directory_iterator(study.out(""))) {
    if (entry.path().extension() != ".json") continue;
    const std::string text = content(entry.path());
    EXPECT_TRUE(json::accept(text)) << entry.path();
    EXPECT_FALSE(std::regex_search(text, not_a_number)) << entry.path();
  }
}

class RunOnValidation : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    study = new StudyCopy("validation");
    outcome = study->run();
  }
  static void TearDownTestSuite() { delete study; }
  static inline StudyCopy* study = nullptr;
  static inline Outcome outcome;
};

TEST_F(RunOnValidation, LeavesEverythingTheContractNames) {
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_contract_of_run(*study);
  for (const char* method : {"sliding_bin", "equation_error", "output_error"}) {
    expect_contract_of_fit(*study, method);
    EXPECT_EQ(first_line(study->out("fit") / method / "curves.csv"), "curve,alpha_T[deg],value[-],sigma[-],count");
  }
  EXPECT_EQ(first_line(study->out("fit/output_error/prediction.csv")).substr(0, 75),
            "t[s],alpha_T_measured[deg],alpha_T_predicted[deg],alpha_T_sigma[deg],held_o");
}

TEST_F(RunOnValidation, SaysThatUncertaintyIsAnotherVerb) {
  const std::string hint = "misfit uncertainty " + study->path("study.toml").string();
  EXPECT_NE(outcome.out.find(hint), std::string::npos) << outcome.out;
  ASSERT_EQ(study->run("uncertainty", {"--method", "sliding_bin", "--runs", "20"}).status, 0);
  EXPECT_EQ(study->run().out.find(hint), std::string::npos) << "it has been done";
}

TEST_F(RunOnValidation, SaysALinePerStageAndEndsWithTheVerdictThatFileAndReportHave) {
  EXPECT_LE(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 40) << outcome.out;
  for (const char* method : {"sliding_bin", "equation_error", "output_error"}) {
    const std::size_t at = outcome.out.find(std::string("\n  ") + method + " ");
    ASSERT_NE(at, std::string::npos) << method << "\n" << outcome.out;
    EXPECT_LT(at, outcome.out.find("\nVerdict\n"));
  }
  const json verdict = study->result("verdict.json");
  for (const char* key : {"verdict", "sentence", "where", "errors", "trim", "next"}) EXPECT_TRUE(verdict.contains(key)) << key;
  const std::string sentence = verdict.at("sentence");
  EXPECT_NE(outcome.out.find("\nVerdict\n" + sentence.substr(0, 60)), std::string::npos) << sentence << outcome.out;
  const std::string page = content(study->out("report.html"));
  EXPECT_LT(page.find("<h2>Verdict</h2>"), page.find("<figure>"));
  EXPECT_NE(outcome.out.find("report: " + study->out("report.html").string()), std::string::npos);
  EXPECT_EQ(html_faults(page), std::vector<std::string>{});
}

TEST_F(RunOnValidation, VerbosePrintsTheTablesInsteadOfLines) {
  const Outcome verbose = study->run("run", {"--verbose"});
  for (const char* table : {"\nResults\n", "linearisations)", "curve C_m"}) {
    EXPECT_NE(verbose.out.find(table), std::string::npos) << table;
    EXPECT_EQ(outcome.out.find(table), std::string::npos) << table;
  }
}

TEST(RunOnAMotor, FindsAddsAndShowsTheFrictionThatItsModelLacks) {
  const StudyCopy study("dc_motor");
  const Outcome outcome = study.run("run", {"--auto"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json verdict = study.result("verdict.json");
  EXPECT_EQ(verdict.at("verdict"), "effect_added");
  const json error = verdict.at("errors").at(0);
  EXPECT_NE(error.at("what").get<std::string>().find("RMS error of w"), std::string::npos);
  EXPECT_LT(error.at("change_per_cent").get<double>(), -75.0);
  const json ladder = study.result("ladder.json");
  ASSERT_EQ(ladder.size(), 2U);
  EXPECT_EQ(ladder[1].at("added"), "coulomb_friction");
  const json friction = ladder[1].at("parameters").at("friction");
  EXPECT_NEAR(friction.at("value").get<double>(), 100.0, 4.0 * friction.at("sigma").get<double>()) << "simulate.awk: c/J [rad/s^2]";
  EXPECT_TRUE(fs::exists(study.out("figures/missing_force_before_and_after.svg")));
  const json map = study.result("diagnosis.json").at("maps").at(0);
  for (const auto& amplitude : map.at("amplitude"))
    EXPECT_LT(std::abs(amplitude.get<double>()), 500.0) << "a force of the size of the friction, not what the drag makes up for";
}

TEST(RunOnAnOscillator, SearchesWhereThatIsAskedThoughTheStudyNamesOutputErrorAlone) {
  const OscillatorStudy study;
  study.write("study.toml", without(content(study.path("study.toml")), ", \"filter_error\""));
  const Outcome outcome = run({"run", study.path("study.toml").string(), "--auto"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json ladder = json::parse(content(study.path("out/ladder.json")));
  ASSERT_EQ(ladder.size(), 2U) << outcome.out;
  EXPECT_EQ(ladder[1].at("added"), "coulomb_friction");
  EXPECT_EQ(json::parse(content(study.path("out/verdict.json"))).at("verdict"), "effect_added");
  expect_parts(outcome.out, {"  output_error ", "  filter_error ", "  diagnose ", "  discover "});
}

TEST_F(RunOnValidation, APipeGetsNoProgressCharacters) {
  EXPECT_EQ((outcome.out + outcome.err).find_first_of("\r\033"), std::string::npos);
}

TEST_F(RunOnValidation, OutputErrorFindsTrimAndNoiseThatWereSimulated) {
  const json fit = study->fit("output_error");
  EXPECT_EQ(fit.at("status"), "converged");
  const double trim = fit.at("trim_deg").at("value"), sigma = fit.at("trim_deg").at("sigma");
  EXPECT_LT(sigma, 0.1);
  EXPECT_LT(std::abs(trim - 12.0), 3.0 * sigma);
  EXPECT_EQ(fit.at("rms").at("alpha_T").at("unit"), "rad");
  EXPECT_NEAR(fit.at("rms").at("alpha_T").at("value").get<double>() * 180.0 / M_PI, 0.1, 0.003);
}

TEST_F(RunOnValidation, OutputErrorFindsTheStaticCurveThatWasSimulated) {
  const std::vector<std::pair<double, double>> truth{{8.0, 0.0165},      {9.0, 0.01415988},   {10.0, 0.0105},
                                                     {11.0, 0.00573216}, {12.0, 0.0},         {13.0, -0.00658853},
                                                     {14.0, -0.014},     {15.0, -0.02219054}, {15.5, -0.02652973}};
  const auto points = curve_points(study->out("fit/output_error/curves.csv"), "C_m");
  double squares = 0.0;
  std::size_t found = 0;
  for (const auto& [alpha_T, C_m] : truth) {
    for (const auto& p : points) {
      if (std::abs(p.x - alpha_T) > 1e-6) continue;
      squares += (p.value - C_m) * (p.value - C_m);
      ++found;
    }
  }
  ASSERT_EQ(found, truth.size());
  EXPECT_LE(std::sqrt(squares / static_cast<double>(found)), 1.5e-4);
}

TEST(RunOnMpfF111, DrivenMotionEndsInWordsThatNameTheMethodForIt) {
  const StudyCopy study("mpf_f111");
  study.start_from_track();
  const Outcome outcome = study.run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_contract_of_run(study);
  for (const char* method : {"sliding_bin", "equation_error", "output_error"}) expect_contract_of_fit(study, method);
  EXPECT_TRUE(first_line(study.out("attitude.csv")).starts_with("t[s],theta[deg],psi[deg],alpha[deg],beta[deg],alpha_T[deg],phi[deg]"));
  const json camera = study.result("camera.json");
  for (const char* key : {"h_c", "K", "names", "covariance", "rms_px", "tests"}) EXPECT_TRUE(camera.contains(key)) << key;
  EXPECT_EQ(camera.at("K").at("unit"), "px/m");

  const json output_error = study.fit("output_error");
  EXPECT_EQ(output_error.at("status"), "declined");
  expect_parts(output_error.at("message"), {"driven", "filter_error"});
  EXPECT_GT(content(study.out("fit/output_error/prediction.csv")).size(), 100'000U);

  bool damping_given = true;
  const json comparison = study.result("compare.json");
  for (const auto& entry : comparison.at("not_compared"))
    if (entry.dump().find("sliding_bin C_m_alphadot") != std::string::npos)
      damping_given = entry.dump().find("not informative") == std::string::npos;
  EXPECT_FALSE(damping_given);
}

}  // namespace
