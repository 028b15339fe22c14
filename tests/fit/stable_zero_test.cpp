#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "misfit/inference/curves.h"

namespace misfit {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// A static curve over 5 to 20 deg with a band of ± 1e-4, visited from 7 to 18 deg, `busy` deg ten times as often.
Fit fit_of(const std::function<double(double)>& C_m, double busy, double sigma = 1e-4) {
  Fit fit;
  CurveEstimate curve;
  curve.name = "C_m";
  curve.of = "alpha_T";
  curve.of_unit = "rad";
  curve.unit = "-";
  curve.trimmed = true;
  for (double a = 5.0; a <= 20.0; a += 0.1) {
    curve.x.push_back(a * degree);
    curve.value.push_back(C_m(a));
    curve.sigma.push_back(sigma);
    curve.count.push_back(a < 7.0 || a > 18.0 ? 0.0 : std::abs(a - busy) < 1.0 ? 100.0 : 10.0);
  }
  fit.curves.push_back(curve);
  return fit;
}

/// Stable at 10.03 and 16.03 deg, unstable at 13.03 deg between them.
double two_trims(double a) { return -1e-4 * (a - 10.03) * (a - 13.03) * (a - 16.03); }

TEST(StableZero, IsWhereTheMostSamplesWere) {
  constexpr double of_the_grid = 0.1 * 0.1 / 8.0 * degree;  // h²/8 C/C', here C'' = C'
  EXPECT_NEAR(stable_zero(fit_of(two_trims, 10.0).curves.front())->value, 10.03 * degree, of_the_grid);
  EXPECT_NEAR(stable_zero(fit_of(two_trims, 16.0).curves.front())->value, 16.03 * degree, of_the_grid);
}

TEST(StableZero, OutsideWhatWasVisitedIsNone) {
  EXPECT_FALSE(stable_zero(fit_of([](double a) { return 0.01 * (19.0 - a); }, 10.0).curves.front()).has_value());
}

TEST(OtherTrims, AreToldWhereTheCurveLeavesZeroBetweenThem) {
  Fit fit = fit_of(two_trims, 16.0);
  warn_of_other_trims(fit);
  ASSERT_EQ(fit.warnings.size(), 1U);
  EXPECT_THAT(fit.warnings.front(), testing::HasSubstr("C_m has 2 stable zeros"));
  EXPECT_THAT(fit.warnings.front(), testing::HasSubstr("10.0"));
  EXPECT_THAT(fit.warnings.front(), testing::HasSubstr("16.0"));
}

TEST(OtherTrims, ThatTheBandDoesNotTellApartAreOne) {
  Fit fit = fit_of(two_trims, 16.0, 1e-3);
  warn_of_other_trims(fit);
  EXPECT_TRUE(fit.warnings.empty()) << fit.warnings.front();
}

TEST(OtherTrims, ThereAreNoneOnACurveThatFalls) {
  Fit fit = fit_of([](double a) { return 0.01 * (12.03 - a); }, 12.0);
  warn_of_other_trims(fit);
  EXPECT_TRUE(fit.warnings.empty());
}

}  // namespace
}  // namespace misfit
