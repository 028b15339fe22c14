// filter_error and diagnose through the program, on a short flight.

#include <cmath>

#include "tests/apps/short_flight.h"

namespace {

using namespace program;

class OnAShortFlight : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    study = new ShortFlight;
    fitted = study->run("fit");
    diagnosed = study->run("diagnose");
  }
  static void TearDownTestSuite() { delete study; }
  static inline ShortFlight* study = nullptr;
  static inline Outcome fitted, diagnosed;
};

TEST_F(OnAShortFlight, FilterErrorPredictsThePixelsAndKnowsTheRandomForce) {
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  const json fit = study->fit("filter_error");
  EXPECT_EQ(fit.at("status"), "converged");
  for (const char* channel : {"P_y", "P_z"}) {
    EXPECT_EQ(fit.at("rms").at(channel).at("unit"), "px");
    EXPECT_NEAR(fit.at("rms").at(channel).at("value").get<double>(), 1.8, 0.4) << channel;
    EXPECT_TRUE(fit.at("validation_rms").contains(channel));
    EXPECT_NEAR(fit.at("noise").at(channel).at("value").get<double>(), 0.5, 0.1) << channel;
  }
  EXPECT_EQ(fit.at("force").at("moment_y").at("unit"), "N m");
  EXPECT_NEAR(fit.at("force").at("moment_y").at("value").get<double>(), 30.0, 8.0);
  EXPECT_FALSE(fit.at("validation_loglik").is_null());
  EXPECT_EQ(first_line(study->out("fit/filter_error/prediction.csv")).substr(0, 53),
            "t[s],P_y_measured[px],P_y_predicted[px],P_y_sigma[px]");
  expect_parts(fitted.out, {"random force, moment_y", "N m", "trim"});
}

TEST_F(OnAShortFlight, TheCameraComesFromItsCalibration) {
  const json camera = study->result("camera.json");
  const std::string resolved = content(study->out("resolved.toml"));
  std::smatch match;
  ASSERT_TRUE(std::regex_search(resolved, match, std::regex(R"(\nh_c = \{ free = true, value = ([-+0-9.e]+))"))) << resolved;
  EXPECT_NEAR(std::stod(match[1]), camera.at("h_c").at("value").get<double>(), 1e-9);
}

TEST_F(OnAShortFlight, DiagnoseSaysWhereFirstAndLeavesItsFiles) {
  ASSERT_EQ(diagnosed.status, 0) << diagnosed.err;
  EXPECT_TRUE(diagnosed.out.starts_with("Where it fails (residuals of filter_error)"));
  EXPECT_LT(diagnosed.out.find("\n  "), diagnosed.out.find("p (corrected)"));
  const json diagnosis = study->result("diagnosis.json");
  EXPECT_FALSE(diagnosis.at("sentences").empty());
  EXPECT_EQ(diagnosis.at("whiteness").size(), 2U);
  ASSERT_FALSE(diagnosis.at("maps").empty());
  for (const char* key : {"port", "port_unit", "quantity", "p_value", "p_corrected", "amplitude", "sigma", "x"})
    EXPECT_TRUE(diagnosis.at("maps").at(0).contains(key)) << key;
  const std::string header = first_line(study->out("missing_force.csv"));
  expect_parts(header, {"t[s]", "moment_y[N m]", "moment_y_sigma[N m]", "phi[deg]"});
  EXPECT_EQ((diagnosed.out + diagnosed.err).find_first_of("\r\033"), std::string::npos);
}

TEST_F(OnAShortFlight, DiagnoseAgainReadsWhatIsThere) {
  const auto before = fs::last_write_time(study->out("diagnosis.json"));
  const Outcome again = study->run("diagnose", {"--json"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(fs::last_write_time(study->out("diagnosis.json")), before);
  EXPECT_EQ(json::parse(again.out).at("sentences"), study->result("diagnosis.json").at("sentences"));
  EXPECT_EQ(again.err, "");
}

TEST(FilterErrorOnHardData, FiveSecondsGiveAnAnswer) {
  const ShortFlight study("parachute_spherical", 5.0);
  const Outcome outcome = study.run("diagnose");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const json fit = study.fit("filter_error");
  EXPECT_TRUE(fit.at("status") == "converged" || fit.at("status") == "not_converged") << fit.at("message");
  if (fit.at("trim_deg").is_null()) return;
  EXPECT_GT(fit.at("trim_deg").at("sigma").get<double>(), 0.2);
}

TEST(FilterErrorOnHardData, EveryParameterFixedIsStillDiagnosed) {
  const ShortFlight study;
  study.change(R"(\[curves\]\n.*\n.*\n)",
               "[parameters]\nC_m = { free = false }\nC_mq = { free = false }\nh_c = { free = false }\nK = { free = false }\n");
  const Outcome outcome = study.run("fit");
  ASSERT_EQ(outcome.status, 0) << outcome.err << outcome.out;
  expect_parts(outcome.out, {"every parameter is fixed"});
  EXPECT_EQ(study.run("diagnose").status, 0);
}

TEST(FilterErrorOnHardData, TooFewSamplesAreRefusedInWords) {
  const ShortFlight study("parachute_spherical", 0.5);
  const Outcome outcome = study.run("diagnose");
  EXPECT_EQ(outcome.status, 1);
  expect_parts(outcome.err, {"samples"});
}

TEST(FilterErrorOnHardData, ATrackOfPureNoiseEndsInWords) {
  const ShortFlight study("parachute_spherical", 6.0);
  unsigned state = 1;
  study.change_rows("track.csv", [&](std::size_t, const std::vector<std::string>& cells) {
    const auto noise = [&] { return std::to_string(static_cast<int>((state = state * 1664525U + 1013904223U) >> 16U) % 400 - 200); };
    const std::string y = noise(), z = noise();
    return cells[0] + "," + y + "," + z;
  });
  const Outcome outcome = study.run("diagnose");
  EXPECT_TRUE(outcome.status == 0 || outcome.status == 1) << outcome.status;
  EXPECT_FALSE((outcome.out + outcome.err).empty());
}

}  // namespace
