#include "misfit/compare/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "misfit/compare/curve_difference.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// value = slope (x − trim) on 0 … 20 deg; visited from `from` to `to` [deg].
CurveEstimate line(double trim, double sigma, double from = 0.0, double to = 20.0) {
  CurveEstimate c{"C_m", "alpha_T", "rad", "-", {}, {}, {}, {}, true, "", true};
  for (double a = 0.0; a <= 20.0; a += 0.5) {
    c.x.push_back(a * degree);
    c.value.push_back(-0.2 * (a - trim) * degree);
    c.sigma.push_back(sigma);
    c.count.push_back(a >= from && a <= to ? 50.0 : 0.0);
  }
  return c;
}

Fit fit(const std::string& method, double trim, double sigma) {
  Fit f;
  f.method = method;
  f.status = FitStatus::converged;
  f.trim = Estimate{trim * degree, 0.3 * degree, "rad"};
  f.curves = {line(trim, sigma)};
  return f;
}

Reference reference(double trim) {
  Reference r{"static_test", "C_m", "alpha_T", "rad", "-", {}, {}, {}, Estimate{trim * degree, 0.4 * degree, "rad"}, {}};
  for (double a = 0.0; a <= 18.0; a += 3.0) {
    r.x.push_back(a * degree);
    r.value.push_back(-0.2 * (a - trim) * degree);
    r.sigma.push_back(0.004);
  }
  return r;
}

TEST(Compare, ParametersThatCannotBothBeRightAreSaidToBe) {
  Fit one = fit("equation_error", 12.0, 0.001), other = fit("output_error", 12.0, 0.001);
  one.parameters = {{"k", {0.9265, 0.0024, "1/s"}}, {"c", {1.0, 0.1, "-"}}, {"C_m[0]", {0.3, 0.001, "-"}}, {"own", {1.0, 0.1, "-"}}};
  other.parameters = {{"k", {0.9999, 0.0003, "1/s"}}, {"c", {1.1, 0.1, "-"}}, {"C_m[0]", {0.4, 0.001, "-"}}};
  const Comparison c = compare({one, other}, {});
  ASSERT_EQ(c.parameters.size(), 2U);
  EXPECT_EQ(c.parameters[0].parameter, "c");
  EXPECT_EQ(c.parameters[0].sentence, "");
  EXPECT_NEAR(c.parameters[1].sigmas, 0.0734 / std::hypot(0.0024, 0.0003), 1e-9);
  expect_parts(c.parameters[1].sentence,
               {"k of equation_error is 0.0734 ± 0.0024 1/s below that of output_error (30.3 sigma)", "numerical differentiation"});
  const TemporaryFolder folder;
  write_comparison(folder.path() / "compare.json", c);
  const Comparison again = read_comparison(folder.path() / "compare.json");
  ASSERT_EQ(again.parameters.size(), 2U);
  EXPECT_EQ(again.parameters[1].sentence, c.parameters[1].sentence);
  EXPECT_EQ(again.methods[0].parameters.at("k").value, 0.9265);
}

TEST(Compare, WhereAModelWithARandomForceAndOneWithoutDifferBothCanBeWrong) {
  Fit one = fit("output_error", 12.0, 0.001), other = fit("filter_error", 12.0, 0.001);
  one.parameters = {{"friction", {0.9, 0.03, "N"}}};
  other.parameters = {{"friction", {0.3, 0.02, "N"}}};
  const Comparison c = compare({one, other}, {});
  ASSERT_EQ(c.parameters.size(), 1U);
  expect_parts(c.parameters[0].sentence,
               {"they cannot both be right", "the random force of filter_error has taken over part of a slow effect",
                "a force that the model lacks biases output_error"});
}

TEST(Compare, SlopeOfALineAtTheTrimIsThatOfTheLine) {
  const Comparison c = compare({fit("output_error", 12.0, 0.001)}, {});
  ASSERT_EQ(c.methods.size(), 1U);
  const Estimate& slope = c.methods[0].slopes.at("C_m");
  EXPECT_NEAR(slope.value, -0.2, 1e-12);
  EXPECT_NEAR(slope.sigma, std::sqrt(2.0) * 0.001 / (2.0 * degree), 1e-12);  // h = 1 deg = 1/20 of the range
  EXPECT_EQ(slope.unit, "1/rad");
}

TEST(Compare, TwoParallelLinesDifferByTheSameNumberOfSigmasEverywhere) {
  const Comparison c = compare({fit("a", 12.0, 0.003), fit("b", 13.0, 0.004)}, {});
  ASSERT_EQ(c.curves.size(), 1U);
  const double sigmas = 0.2 * degree / 0.005;
  EXPECT_NEAR(c.curves[0].rms_sigmas, sigmas, 1e-9);
  EXPECT_NEAR(c.curves[0].max_sigmas, sigmas, 1e-9);
  EXPECT_NEAR(c.curves[0].difference.value, -0.2 * degree, 1e-12);
  EXPECT_NEAR(c.curves[0].difference.sigma, 0.005, 1e-12);
  EXPECT_EQ(c.curves[0].points, 41U);
}

TEST(Compare, TheLargestDifferenceIsFoundWhereItIs) {
  Fit a = fit("a", 12.0, 0.003);
  a.curves[0].value[20] += 0.05;  // at 10 deg
  const Comparison c = compare({a, fit("b", 12.0, 0.004)}, {});
  ASSERT_EQ(c.curves.size(), 1U);
  EXPECT_NEAR(c.curves[0].at, 10.0 * degree, 1e-12);
  EXPECT_NEAR(c.curves[0].max_sigmas, 10.0, 1e-9);
  EXPECT_NEAR(c.curves[0].rms_sigmas, 10.0 / std::sqrt(41.0), 1e-9);
}

TEST(Compare, OnlyTheRangeThatBothVisitedCounts) {
  Fit a = fit("a", 12.0, 0.003);
  Fit b = fit("b", 12.0, 0.004);
  a.curves = {line(12.0, 0.003, 4.0, 15.0)};
  b.curves = {line(12.0, 0.004, 8.0, 20.0)};
  b.curves[0].value[2] = 1e6;  // at 1 deg, not visited
  const Comparison c = compare({a, b}, {});
  ASSERT_EQ(c.curves.size(), 1U);
  EXPECT_NEAR(c.curves[0].from, 8.0 * degree, 1e-12);
  EXPECT_NEAR(c.curves[0].to, 15.0 * degree, 1e-12);
  EXPECT_NEAR(c.curves[0].max_sigmas, 0.0, 1e-9);
}

TEST(Compare, RangesThatDoNotMeetAreListedNotCompared) {
  Fit a = fit("a", 12.0, 0.003);
  Fit b = fit("b", 12.0, 0.004);
  a.curves = {line(12.0, 0.003, 0.0, 6.0)};
  b.curves = {line(12.0, 0.004, 10.0, 20.0)};
  const Comparison c = compare({a, b}, {});
  EXPECT_TRUE(c.curves.empty());
  ASSERT_EQ(c.not_compared.size(), 1U);
  expect_parts(c.not_compared[0].what + c.not_compared[0].why, {"C_m of a and b", "no common operating range"});
}

TEST(Compare, OnlyLikeWithLike) {
  Fit a = fit("a", 12.0, 0.003);
  Fit b = fit("b", 12.0, 0.004);
  b.curves[0].name = "C_mq";
  EXPECT_TRUE(compare({a, b}, {}).curves.empty());
  b.curves[0].name = "C_m";
  b.curves[0].of = "eta";
  EXPECT_TRUE(compare({a, b}, {}).curves.empty());
}

TEST(Compare, DeclinedFitsAndCurvesWithoutInformationAreListedWithWhy) {
  Fit declined = fit("output_error", 12.0, 0.003);
  declined.status = FitStatus::declined;
  declined.message = "the motion is driven";
  Fit bin = fit("sliding_bin", 12.0, 0.003);
  bin.curves[0].informative = false;
  bin.curves[0].why = "the sum telescopes";
  const Comparison c = compare({declined, bin, fit("filter_error", 12.0, 0.003)}, {reference(12.0)});
  ASSERT_EQ(c.curves.size(), 1U);  // filter_error against the reference
  EXPECT_EQ(c.curves[0].a, "filter_error");
  ASSERT_EQ(c.not_compared.size(), 2U);
  expect_parts(c.not_compared[0].what + " " + c.not_compared[0].why, {"output_error", "declined", "the motion is driven"});
  expect_parts(c.not_compared[1].what + " " + c.not_compared[1].why, {"sliding_bin C_m", "not informative", "the sum telescopes"});
  EXPECT_TRUE(c.methods[1].slopes.empty());
}

TEST(Compare, TrimAgainstTheReferenceIsSaidInWords) {
  const Comparison c = compare({fit("filter_error", 10.0, 0.003)}, {reference(12.0)});
  ASSERT_EQ(c.trims.size(), 1U);
  EXPECT_TRUE(c.trims[0].reference);
  EXPECT_NEAR(c.trims[0].sigmas, 4.0, 1e-9);  // 2 deg over 0.5 deg
  EXPECT_EQ(c.trims[0].sentence, "the trim of filter_error is 2.00 ± 0.50 deg below that of static_test (4.0 sigma)");
  ASSERT_EQ(c.curves.size(), 1U);
  EXPECT_NEAR(c.curves[0].max_sigmas, 0.2 * 2.0 * degree / 0.005, 1e-9);
}

TEST(Compare, BetweenGridPointsValuesAreInterpolatedAndNothingIsExtrapolated) {
  const CurveEstimate c = line(12.0, 0.002, 4.0, 15.0);
  const auto between = visited_point(c, 10.25 * degree);
  ASSERT_TRUE(between.has_value());
  EXPECT_NEAR(between->value, -0.2 * (10.25 - 12.0) * degree, 1e-12);
  EXPECT_FALSE(visited_point(c, 3.75 * degree).has_value());
  EXPECT_FALSE(visited_point(c, 15.25 * degree).has_value());
  EXPECT_FALSE(visited_point(c, 40.0 * degree).has_value());
  EXPECT_FALSE(slope_at(c, 4.0 * degree).has_value());
}

TEST(Compare, NothingToCompareIsAnEmptyComparison) {
  const Comparison c = compare({}, {reference(12.0)});
  EXPECT_TRUE(c.methods.empty());
  EXPECT_TRUE(c.curves.empty());
  EXPECT_EQ(c.reference_trims.count("static_test"), 1U);
}

}  // namespace
}  // namespace misfit
