#include "misfit/inference/own_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "misfit/inference/own_clocks.h"

namespace misfit {
namespace {

/// Rows at 400 Hz, uneven; a channel at every fourth of them, sin(3 t).
struct Rows {
  std::vector<double> t, y;
  Rows() {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(-0.3, 0.3);
    for (int i = 0; i < 2000; ++i) {
      t.push_back(0.0025 * (i + uniform(random)));
      y.push_back(i % 4 == 1 ? std::sin(3.0 * t.back()) : std::nan(""));
    }
  }
};

TEST(OwnSamples, AreInterpolatedWithItsDerivatives) {
  const Rows rows;
  const OwnSamples channel(rows.t, rows.y);
  double value = 0.0, slope = 0.0, curvature = 0.0;
  for (std::size_t i = 12; i + 12 < rows.t.size(); ++i) {
    const LocalFit fit = channel.at(rows.t[i]);
    ASSERT_TRUE(fit.ok) << i;
    value = std::max(value, std::abs(fit.value - std::sin(3.0 * rows.t[i])));
    slope = std::max(slope, std::abs(fit.slope - 3.0 * std::cos(3.0 * rows.t[i])));
    curvature = std::max(curvature, std::abs(fit.curvature + 9.0 * std::sin(3.0 * rows.t[i])));
  }
  EXPECT_LT(value, 1e-4);
  EXPECT_LT(slope, 0.02) << "of 3";
  EXPECT_LT(curvature, 1.0) << "of 9, about a tenth at times as uneven";
  EXPECT_FALSE(channel.at(rows.t[0]).ok) << "ahead of its first sample";
}

/// Of two channels, every `every`-th row the second, the first in the rows that `both` lets it keep.
Signals two_sensors(std::size_t every, double together) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Signals out;
  out.measured = {{"a", "m", {}, 0.0}, {"b", "m", {}, 0.0}};
  for (std::size_t i = 0; i < 1000; ++i) {
    const bool second = i % every == 0;
    out.t.push_back(0.001 * static_cast<double>(i));
    out.measured[0].values.push_back(!second || uniform(random) < together ? 1.0 : std::nan(""));
    out.measured[1].values.push_back(second ? 2.0 : std::nan(""));
  }
  return out;
}

TEST(OwnClocks, AreThoseOfSensorsThatAreHardlyEverMeasuredTogether) {
  EXPECT_TRUE(have_own_clocks(two_sensors(5, 0.0)));
  EXPECT_TRUE(have_own_clocks(two_sensors(5, 0.3)));
  EXPECT_FALSE(have_own_clocks(two_sensors(5, 1.0))) << "a slow channel on some of the rows of the fast one";
  EXPECT_FALSE(have_own_clocks(two_sensors(1, 0.7))) << "samples that are lost";
  Signals one = two_sensors(2, 0.0);
  one.measured.pop_back();
  EXPECT_FALSE(have_own_clocks(one));
}

TEST(OwnClocks, HaveTheStepOfTheFastestSensor) {
  EXPECT_NEAR(step_of_measurements(two_sensors(5, 0.0)), 0.001, 1e-9);
  Signals pairs = two_sensors(2, 0.0);  // b, a 50 us behind it, b, a, …
  for (std::size_t i = 0; i < pairs.samples(); ++i) {
    const std::size_t pair = i / 2;
    pairs.t[i] = 0.004 * static_cast<double>(pair) + (i % 2 == 1 ? 5e-5 : 0.0);
  }
  EXPECT_NEAR(step_of_measurements(pairs), 0.004, 1e-9);
  EXPECT_NEAR(own_step(pairs, 1), 0.004, 1e-9);
  EXPECT_NEAR(step_of_measurements(two_sensors(5, 1.0)), 0.001, 1e-9);
}

TEST(OwnSamples, AreNotStretchedOverAGap) {
  Rows rows;
  for (std::size_t i = 800; i < 900; ++i) rows.y[i] = std::nan("");
  const OwnSamples channel(rows.t, rows.y);
  EXPECT_FALSE(channel.at(rows.t[850]).ok);
  EXPECT_TRUE(channel.at(rows.t[950]).ok);
}

}  // namespace
}  // namespace misfit
