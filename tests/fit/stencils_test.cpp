#include "misfit/fit/regression/stencils.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace misfit {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

std::vector<double> times(std::size_t n, double h, double start = 0.0) {
  std::vector<double> t(n);
  for (std::size_t i = 0; i < n; ++i) t[i] = start + static_cast<double>(i) * h;
  return t;
}

std::vector<double> sampled(const std::vector<double>& t, const std::function<double(double)>& f) {
  std::vector<double> y;
  for (double s : t) y.push_back(f(s));
  return y;
}

/// Error of rate and acceleration of sin(t + 0.4) at the middle of five samples with step h.
struct Errors {
  double rate, acceleration;
};
Errors sine_errors(Stencils stencils, double h) {
  const auto t = times(5, h, -2.0 * h);
  const StencilMotion m = stencil_motion(t, sampled(t, [](double s) { return std::sin(s + 0.4); }), stencils);
  return {std::abs(m.rate[2] - std::cos(0.4)), std::abs(m.acceleration[2] + std::sin(0.4))};
}

TEST(Stencils, FourthOrderIsExactOnPolynomialsOfDegreeFourAndFive) {
  const auto t = times(7, 0.1, 0.3);
  const StencilMotion quartic =
      stencil_motion(t, sampled(t, [](double s) { return 1 + s * (2 + s * (-3 + s * (4 - 5 * s))); }), Stencils::fourth_order);
  const StencilMotion quintic = stencil_motion(t, sampled(t, [](double s) { return std::pow(s, 5) - s * s; }), Stencils::fourth_order);
  for (std::size_t i = 2; i < 5; ++i) {
    const double s = t[i];
    EXPECT_NEAR(quartic.rate[i], 2 - 6 * s + 12 * s * s - 20 * s * s * s, 1e-12);
    EXPECT_NEAR(quartic.acceleration[i], -6 + 24 * s - 60 * s * s, 1e-11);
    EXPECT_NEAR(quintic.acceleration[i], 20 * s * s * s - 2, 1e-11);
  }
}

TEST(Stencils, SecondOrderIsExactOnQuadraticsForTheRateAndCubicsForTheAcceleration) {
  const auto t = times(7, 0.1, 0.3);
  const StencilMotion quadratic =
      stencil_motion(t, sampled(t, [](double s) { return 1 + 2 * s - 3 * s * s; }), Stencils::second_order_four_point);
  const StencilMotion cubic =
      stencil_motion(t, sampled(t, [](double s) { return s * s * (4 * s - 3); }), Stencils::second_order_four_point);
  for (std::size_t i = 2; i < 5; ++i) {
    EXPECT_NEAR(quadratic.rate[i], 2 - 6 * t[i], 1e-12);
    EXPECT_NEAR(quadratic.acceleration[i], -6.0, 1e-11);
    EXPECT_NEAR(cubic.acceleration[i], 24 * t[i] - 6, 1e-11);
  }
}

TEST(Stencils, LeadingErrorsAreThoseOfTheDocumentation) {
  constexpr double h = 0.1;  // on t⁴: f⁗ = 24; on t³: f''' = 6; on t⁵: f⁽⁵⁾ = 120; on t⁶: f⁽⁶⁾ = 720
  const auto t = times(5, h, -2.0 * h);
  const auto at_middle = [&](int power, Stencils s) {
    return stencil_motion(t, sampled(t, [power](double x) { return std::pow(x, power); }), s);
  };
  EXPECT_NEAR(at_middle(4, Stencils::second_order_four_point).acceleration[2], 5.0 * h * h * 24.0 / 12.0, 1e-12);
  EXPECT_NEAR(at_middle(3, Stencils::second_order_four_point).rate[2], 17.0 * h * h * 6.0 / 30.0, 1e-12);
  EXPECT_NEAR(at_middle(5, Stencils::fourth_order).rate[2], -std::pow(h, 4) * 120.0 / 30.0, 1e-12);
  EXPECT_NEAR(at_middle(6, Stencils::fourth_order).acceleration[2], -std::pow(h, 4) * 720.0 / 90.0, 1e-12);
}

TEST(Stencils, ConvergeWithTheirOrderOnASine) {
  const auto order = [](double coarse, double fine) { return std::log2(coarse / fine); };
  const Errors c4 = sine_errors(Stencils::fourth_order, 0.1), f4 = sine_errors(Stencils::fourth_order, 0.05);
  const Errors c2 = sine_errors(Stencils::second_order_four_point, 0.1), f2 = sine_errors(Stencils::second_order_four_point, 0.05);
  EXPECT_NEAR(order(c4.rate, f4.rate), 4.0, 0.02);
  EXPECT_NEAR(order(c4.acceleration, f4.acceleration), 4.0, 0.02);
  EXPECT_NEAR(order(c2.rate, f2.rate), 2.0, 0.02);
  EXPECT_NEAR(order(c2.acceleration, f2.acceleration), 2.0, 0.02);
}

TEST(Stencils, AMissingSampleIsMissedByTheFiveStencilsThatHoldIt) {
  const auto t = times(15, 0.1);
  auto f = sampled(t, [](double s) { return s * s; });
  f[7] = nan_value;
  for (Stencils stencils : {Stencils::fourth_order, Stencils::second_order_four_point}) {
    const StencilMotion m = stencil_motion(t, f, stencils);
    for (std::size_t i = 0; i < t.size(); ++i) {
      const bool usable = (i >= 2 && i <= 4) || (i >= 10 && i <= 12);
      EXPECT_EQ(std::isfinite(m.level[i]), usable) << i;
      EXPECT_EQ(std::isfinite(m.rate[i]), usable) << i;
      EXPECT_EQ(std::isfinite(m.acceleration[i]), usable) << i;
    }
  }
}

TEST(Stencils, AGapInTimeBreaksStencilsAndAverages) {
  auto t = times(12, 0.1);
  for (std::size_t i = 6; i < t.size(); ++i) t[i] += 0.3;  // between samples 5 and 6
  const auto f = sampled(t, [](double s) { return 2.0 * s; });
  const StencilMotion m = stencil_motion(t, f, Stencils::fourth_order);
  for (std::size_t i = 0; i < t.size(); ++i) EXPECT_EQ(std::isfinite(m.rate[i]), i == 2 || i == 3 || i == 8 || i == 9) << i;
  const auto mean = average_of_three(t, f);
  for (std::size_t i = 0; i < t.size(); ++i) EXPECT_EQ(std::isfinite(mean[i]), i != 0 && i != 5 && i != 6 && i != 11) << i;
}

TEST(Stencils, StepsMayDifferByLessThanTwentyPercentOfTheirMean) {
  const std::vector<double> f = {0.0, 1.0, 2.0, 3.0, 4.0};
  EXPECT_TRUE(std::isfinite(stencil_motion({0.0, 0.1, 0.2, 0.3, 0.419}, f, Stencils::fourth_order).rate[2]));
  EXPECT_FALSE(std::isfinite(stencil_motion({0.0, 0.1, 0.2, 0.3, 0.422}, f, Stencils::fourth_order).rate[2]));
  EXPECT_NEAR(stencil_motion({0.0, 0.1, 0.2, 0.3, 0.4}, f, Stencils::fourth_order).rate[2], 10.0, 1e-12);
}

TEST(Stencils, AverageOfThreeIsTheMeanOfNeighbours) {
  const auto mean = average_of_three(times(5, 0.1), {1.0, 2.0, 6.0, 1.0, nan_value});
  EXPECT_TRUE(std::isnan(mean[0]));
  EXPECT_DOUBLE_EQ(mean[1], 3.0);
  EXPECT_DOUBLE_EQ(mean[2], 3.0);
  EXPECT_TRUE(std::isnan(mean[3]));
  EXPECT_TRUE(std::isnan(mean[4]));
}

TEST(Stencils, FewerThanFiveSamplesGiveNothing) {
  for (std::size_t n = 0; n < 5; ++n) {
    const auto t = times(n, 0.1);
    for (double r : stencil_motion(t, t, Stencils::fourth_order).rate) EXPECT_TRUE(std::isnan(r));
    EXPECT_EQ(average_of_three(t, t).size(), n);
  }
}

}  // namespace
}  // namespace misfit
