#include "misfit/data/comparison.h"

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

Comparison example() {
  Comparison c;
  c.methods = {{"sliding_bin",
                FitStatus::converged,
                "",
                false,
                Estimate{13.2 * degree, 0.3 * degree, "rad"},
                {{"C_m", {-0.35, 0.04, "1/rad"}}},
                {},
                {},
                {},
                std::nullopt,
                std::nullopt,
                {{"m_a", {0.3, 0.1, "kg"}}}}};
  c.curves = {{"C_m",
               "alpha_T",
               "rad",
               "-",
               "sliding_bin",
               "static_test",
               true,
               3.0 * degree,
               18.0 * degree,
               20,
               2.0,
               5.0,
               18.0 * degree,
               {0.01, 0.002, "-"}}};
  TrimDifference trim;
  trim.a = "sliding_bin";
  trim.b = "static_test";
  trim.reference = true;
  trim.difference = Estimate{degree, 0.0, std::string("rad")};
  trim.sigmas = std::numeric_limits<double>::quiet_NaN();
  trim.sentence = "a sentence";
  c.trims.push_back(trim);
  c.not_compared = {{"equation_error", "declined: too few samples"}};
  c.reference_trims = {{"static_test", {12.2 * degree, 0.0, "rad"}}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const MotionGroup spread{"distribution", "rad", {{"mean", nan, 13.0 * degree, 12.0 * degree, 12.5 * degree, 14.0 * degree, false}}, 0.4};
  const MotionGroup power{"spectrum", "dB", {{"power", 1.5, -3.0, -2.0, -1.0, 0.0, true}}, 0.005};
  c.motion =
      SimulatedMotion{"filter_error", 199, 1, {{"flight", "alpha_T", "rad", {spread, power}}}, 0.02, {"a sentence"}, {"a note"}, 2.0};
  return c;
}

TEST(Comparison, JsonIsInDegreesAndNullWhereNotKnown) {
  const TemporaryFolder folder;
  write_comparison(folder.path() / "compare.json", example());
  const nlohmann::json root = nlohmann::json::parse(read_file(folder.path() / "compare.json"));
  const nlohmann::json& method = root.at("methods").at("sliding_bin");
  EXPECT_NEAR(method["trim_deg"]["value"].get<double>(), 13.2, 1e-12);
  EXPECT_TRUE(method["loglik"].is_null());
  EXPECT_EQ(method["slopes"]["C_m"]["unit"], "1/rad");
  EXPECT_TRUE(root["curves"].empty());
  EXPECT_NEAR(root["references"][0]["at"].get<double>(), 18.0, 1e-12);
  EXPECT_EQ(root["references"][0]["of_unit"], "deg");
  EXPECT_TRUE(root["trims"][0]["sigmas"].is_null());
  EXPECT_TRUE(root["reference_trims_deg"]["static_test"]["sigma"].is_null());
  EXPECT_EQ(root["not_compared"][0]["what"], "equation_error");
  const nlohmann::json& group = root["simulated_motion"]["series"][0]["groups"][0];
  EXPECT_EQ(group["unit"], "deg");
  EXPECT_NEAR(group["statistics"][0]["measured"].get<double>(), 13.0, 1e-12);
  EXPECT_TRUE(group["statistics"][0]["at"].is_null());
}

TEST(Comparison, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const Comparison c = example();
  write_comparison(folder.path() / "compare.json", c);
  const Comparison back = read_comparison(folder.path() / "compare.json");
  ASSERT_EQ(back.methods.size(), 1U);
  EXPECT_NEAR(back.methods[0].trim->sigma, 0.3 * degree, 1e-15);
  ASSERT_EQ(back.curves.size(), 1U);
  EXPECT_TRUE(back.curves[0].reference);
  EXPECT_EQ(back.curves[0].points, 20U);
  EXPECT_NEAR(back.curves[0].at, 18.0 * degree, 1e-15);
  EXPECT_EQ(back.curves[0].unit, "-");
  ASSERT_EQ(back.trims.size(), 1U);
  EXPECT_NEAR(back.trims[0].difference.value, degree, 1e-15);
  EXPECT_TRUE(std::isnan(back.trims[0].sigmas));
  EXPECT_NEAR(back.reference_trims.at("static_test").value, 12.2 * degree, 1e-15);
  ASSERT_TRUE(back.motion.has_value());
  EXPECT_EQ(back.motion->runs, 199U);
  EXPECT_EQ(back.motion->p_value, 0.02);
  EXPECT_EQ(back.motion->sentences, c.motion->sentences);
  const std::vector<MotionGroup>& groups = back.motion->series.at(0).groups;
  EXPECT_NEAR(groups.at(0).numbers.at(0).high, 14.0 * degree, 1e-15);
  EXPECT_EQ(groups.at(1).unit, "dB");
  EXPECT_EQ(groups.at(1).numbers.at(0).measured, -3.0);
  EXPECT_TRUE(groups.at(1).numbers.at(0).outside);
  EXPECT_EQ(groups.at(1).p_value, 0.005);
}

TEST(Comparison, ABrokenFileIsNamed) {
  const TemporaryFolder folder;
  const auto path = folder.write("compare.json", "{}");
  expect_parts(message_of<InputError>([&] { static_cast<void>(read_comparison(path)); }), {"compare.json", "methods"});
}

}  // namespace
}  // namespace misfit
