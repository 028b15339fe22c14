#include "misfit/data/fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

CurveEstimate curve(const std::string& name) {
  return {name, "alpha_T", "rad", "-", {0.0, 10.0 * degree, 20.0 * degree}, {0.0, 0.0105, -0.04}, {nan, 0.001, 0.02}, {0.0, 120.0, 3.0},
          true, ""};
}

Fit example() {
  Fit fit;
  fit.method = "filter_error";
  fit.status = FitStatus::not_converged;
  fit.message = "iteration limit, \"50\"";
  fit.warnings = {"m_a ± 0.1 kg is ± 20 %"};
  fit.parameters = {{"R_cp", {3.15, 0.02, "m"}}, {"C_m[0]", {0.011, 0.0, "-"}}};
  fit.names = {"R_cp", "C_m[0]"};
  fit.covariance = Eigen::MatrixXd::Identity(2, 2) * 4e-4;
  fit.noise = {{"white", {0.5, 0.01, "px"}}};
  fit.force = {{"sigma", {27.0, nan, "N m"}}, {"correlation_time", {0.1, 0.025, "s", std::pair(0.067, 0.19)}}};
  fit.loglik = 1234.5;
  fit.trim = Estimate{12.0 * degree, 0.2 * degree, "rad", std::pair{11.5 * degree, 12.5 * degree}};
  fit.rms = {{"alpha_T", {0.01, 0.0, "rad"}}};
  fit.curves = {curve("C_m"), curve("C_m_alphadot")};
  fit.curves[1].informative = false;
  fit.curves[0].trimmed = true;
  fit.curves[1].why = "the sum telescopes";
  fit.predictions = {{"flight", "alpha_T", "rad", {0.0, 0.5}, {0.2, nan}, {0.21, 0.22}, {0.01, 0.01}, {false, true}}};
  fit.roughness = {
      {"C_m", "rad^3", 1e-4, true, {1e-5, 1e-4}, {-2.0, 0.0}, {{"C_m", "alpha_T", "rad", "-", {0.0, 0.1}, {{1.0, 2.0}, {1.5, 1.75}}}}}};
  fit.facts = {{"telescoped_sum", "0.01 ± 0.02"}};
  fit.driven = true;
  fit.seconds = 2.5;
  fit.linearisations = 14;
  return fit;
}

nlohmann::json written(const std::filesystem::path& dir) { return nlohmann::json::parse(read_file(dir / "fit.json")); }

TEST(Fit, JsonHasTheKeysOfTheContract) {
  const TemporaryFolder folder;
  write_fit(folder.path(), example());
  const nlohmann::json root = written(folder.path());
  for (const char* key : {"method", "status", "message", "parameters", "noise", "force", "loglik", "validation_loglik", "trim_deg", "rms",
                          "validation_rms", "seconds", "linearisations"}) {
    EXPECT_TRUE(root.contains(key)) << key;
  }
  EXPECT_EQ(root["status"], "not_converged");
  EXPECT_EQ(root["parameters"]["R_cp"], (nlohmann::json{{"value", 3.15}, {"sigma", 0.02}, {"unit", "m"}}));
  EXPECT_NEAR(root["trim_deg"]["value"].get<double>(), 12.0, 1e-12);
  EXPECT_NEAR(root["trim_deg"]["sigma"].get<double>(), 0.2, 1e-12);
  EXPECT_EQ(root["rms"]["alpha_T"]["unit"], "rad");
}

TEST(Fit, WhatIsNotKnownIsNullAndNeverNan) {
  const TemporaryFolder folder;
  Fit fit = example();
  fit.seconds = nan;
  fit.trim.reset();
  write_fit(folder.path(), fit);
  const nlohmann::json root = written(folder.path());
  EXPECT_TRUE(root["force"]["sigma"]["sigma"].is_null());
  EXPECT_TRUE(root["parameters"]["C_m[0]"]["sigma"].is_null());
  EXPECT_TRUE(root["validation_loglik"].is_null());
  EXPECT_TRUE(root["seconds"].is_null());
  EXPECT_TRUE(root["trim_deg"].is_null());
  EXPECT_EQ(read_file(folder.path() / "fit.json").find("nan"), std::string::npos);
  EXPECT_EQ(read_file(folder.path() / "curves.csv").find("nan"), std::string::npos);
}

TEST(Fit, ADoubtIsAWarningToo) {
  const TemporaryFolder folder;
  Fit fit = example();
  fit.warnings.clear();
  EXPECT_FALSE(fit.doubts.has_value());
  fit.add_doubt("tau ends at its bound, 0.01 s", ": the best value may lie beyond");
  EXPECT_EQ(fit.warnings, std::vector<std::string>{"tau ends at its bound, 0.01 s: the best value may lie beyond"});
  write_fit(folder.path(), fit);
  EXPECT_EQ(read_fit(folder.path()).doubts, std::vector<std::string>{"tau ends at its bound, 0.01 s"});
}

TEST(Fit, WhatIsPredictedFarAheadIsKeptWhereThereIsSomething) {
  const TemporaryFolder folder;
  Fit fit = example();
  fit.predictions = {{"test", "a", "m", {0.0, 0.1}, {1.0, 2.0}, {1.1, 2.1}, {0.1, 0.1}, {false, true}}};
  fit.predictions.push_back(fit.predictions.front());
  fit.predictions.back().channel = "b";
  fit.predictions.back().ahead = {nan, 2.5};
  write_fit(folder.path(), fit);
  const Fit read = read_fit(folder.path());
  ASSERT_EQ(read.predictions.size(), 2U);
  EXPECT_TRUE(read.predictions[0].ahead.empty());
  ASSERT_EQ(read.predictions[1].ahead.size(), 2U);
  EXPECT_TRUE(std::isnan(read.predictions[1].ahead[0]));
  EXPECT_EQ(read.predictions[1].ahead[1], 2.5);
}

TEST(Fit, CurvesStandInOneFileInDegrees) {
  const TemporaryFolder folder;
  write_fit(folder.path(), example());
  const std::string text = read_file(folder.path() / "curves.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')), "curve,alpha_T[deg],value[-],sigma[-],count");
  EXPECT_NE(text.find("C_m,0,0,,0\n"), std::string::npos);
  EXPECT_NE(text.find("C_m,10,0.0105,0.001,120\n"), std::string::npos);
  EXPECT_NE(text.find("C_m_alphadot,20,-0.04,0.02,3\n"), std::string::npos);
}

TEST(Fit, ACurveOfAnotherQuantityGetsItsOwnFile) {
  const TemporaryFolder folder;
  Fit fit = example();
  fit.curves.insert(fit.curves.begin(), {"spill", "x1", "V", "V/s", {1.0, 2.0}, {0.1, 0.2}, {0.01, 0.01}, {5.0, 6.0}, true, ""});
  write_fit(folder.path(), fit);
  EXPECT_EQ(read_file(folder.path() / "curves_x1.csv"),
            "curve,x1[V],value[V/s],sigma[V/s],count\nspill,1,0.1,0.01,5\nspill,2,0.2,0.01,6\n");
  const Fit back = read_fit(folder.path());
  ASSERT_EQ(back.curves.size(), 3U);
  EXPECT_EQ(back.curves[2].name, "spill");
  EXPECT_EQ(back.curves[2].value, (std::vector<double>{0.1, 0.2}));
}

TEST(Fit, PredictionHasUnitsAndTheHeldOutPart) {
  const TemporaryFolder folder;
  write_fit(folder.path(), example());
  const std::string text = read_file(folder.path() / "prediction.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')), "t[s],alpha_T_measured[deg],alpha_T_predicted[deg],alpha_T_sigma[deg],held_out");
}

TEST(Fit, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const Fit fit = example();
  write_fit(folder.path(), fit);
  const Fit back = read_fit(folder.path());
  EXPECT_EQ(back.method, fit.method);
  EXPECT_EQ(back.status, fit.status);
  EXPECT_EQ(back.message, fit.message);
  EXPECT_EQ(back.warnings, fit.warnings);
  EXPECT_EQ(back.force.at("correlation_time").interval, fit.force.at("correlation_time").interval);
  EXPECT_FALSE(back.force.at("sigma").interval.has_value());
  EXPECT_EQ(back.names, fit.names);
  EXPECT_EQ(back.covariance, fit.covariance);
  EXPECT_EQ(back.facts, fit.facts);
  EXPECT_EQ(back.loglik, fit.loglik);
  EXPECT_FALSE(back.validation_loglik.has_value());
  EXPECT_TRUE(back.driven);
  EXPECT_EQ(back.linearisations, 14);
  EXPECT_NEAR(back.trim->value, fit.trim->value, 1e-15);
  ASSERT_TRUE(back.trim->interval.has_value());
  EXPECT_NEAR(back.trim->interval->second, 12.5 * degree, 1e-15);
  EXPECT_EQ(back.parameters.at("C_m[0]").sigma, 0.0);
  ASSERT_EQ(back.curves.size(), 2U);
  EXPECT_FALSE(back.curves[1].informative);
  EXPECT_TRUE(back.curves[0].trimmed);
  EXPECT_FALSE(back.curves[1].trimmed);
  EXPECT_EQ(back.curves[1].why, "the sum telescopes");
  EXPECT_NEAR(back.curves[0].x[1], 10.0 * degree, 1e-12);
  EXPECT_TRUE(std::isnan(back.curves[0].sigma[0]));
  ASSERT_EQ(back.predictions.size(), 1U);
  EXPECT_NEAR(back.predictions[0].measured[0], 0.2, 1e-12);
  EXPECT_TRUE(std::isnan(back.predictions[0].measured[1]));
  EXPECT_EQ(back.predictions[0].held_out, fit.predictions[0].held_out);
}

TEST(Fit, WhatAnotherRoughnessMakesOfItIsReadBackAndGoesWithTheCurves) {
  const TemporaryFolder folder;
  Fit fit = example();
  write_fit(folder.path(), fit);
  const std::vector<RoughnessPath> back = read_fit(folder.path()).roughness;
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].curve, "C_m");
  EXPECT_EQ(back[0].unit, "rad^3");
  EXPECT_EQ(back[0].used, 1e-4);
  EXPECT_TRUE(back[0].chosen);
  EXPECT_EQ(back[0].roughness, fit.roughness[0].roughness);
  EXPECT_EQ(back[0].log_likelihood, fit.roughness[0].log_likelihood);
  ASSERT_EQ(back[0].curves.size(), 1U);
  EXPECT_EQ(back[0].curves[0].of, "alpha_T");
  EXPECT_EQ(back[0].curves[0].x, fit.roughness[0].curves[0].x);
  EXPECT_EQ(back[0].curves[0].values, fit.roughness[0].curves[0].values);
  fit.roughness.clear();
  write_fit(folder.path(), fit);
  EXPECT_TRUE(read_fit(folder.path()).roughness.empty());
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "roughness.json"));
}

TEST(Fit, TheSecondExperimentGetsItsOwnPredictions) {
  const TemporaryFolder folder;
  Fit fit = example();
  fit.predictions.push_back({"second", "alpha_T", "rad", {1.0}, {0.1}, {0.1}, {0.01}, {false}});
  write_fit(folder.path(), fit);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "prediction_second.csv"));
  EXPECT_NEAR(read_fit(folder.path()).predictions.at(1).t.at(0), 1.0, 1e-12);
}

TEST(Fit, ChannelsOnDifferentTimesAreRefused) {
  const TemporaryFolder folder;
  Fit fit = example();
  fit.predictions.push_back({"flight", "phi", "rad", {1.0}, {0.1}, {0.1}, {0.01}, {false}});
  expect_parts(message_of<RunError>([&] { write_fit(folder.path(), fit); }), {"prediction.csv", "alpha_T", "phi", "time base"});
}

TEST(Fit, ABrokenFileIsNamedInTheError) {
  const TemporaryFolder folder;
  folder.write("fit.json", "{\"method\": \"x\"}");
  expect_parts(message_of<InputError>([&] { static_cast<void>(read_fit(folder.path())); }), {"fit.json", "status"});
  write_fit(folder.path(), example());
  std::string text = read_file(folder.path() / "curves.csv");
  text.replace(text.find("C_m,10"), 3, "C_x");
  folder.write("curves.csv", text);
  expect_parts(message_of<InputError>([&] { static_cast<void>(read_fit(folder.path())); }), {"curves.csv:3", "C_x", "C_m"});
}

}  // namespace
}  // namespace misfit
