#include "misfit/inference/slow_channel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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

TEST(SlowChannel, IsInterpolatedWithItsDerivatives) {
  const Rows rows;
  const auto channel = SlowChannel::of(rows.t, rows.y);
  ASSERT_TRUE(channel);
  double value = 0.0, slope = 0.0, curvature = 0.0;
  for (std::size_t i = 12; i + 12 < rows.t.size(); ++i) {
    const LocalFit fit = channel->at(rows.t[i]);
    ASSERT_TRUE(fit.ok) << i;
    value = std::max(value, std::abs(fit.value - std::sin(3.0 * rows.t[i])));
    slope = std::max(slope, std::abs(fit.slope - 3.0 * std::cos(3.0 * rows.t[i])));
    curvature = std::max(curvature, std::abs(fit.curvature + 9.0 * std::sin(3.0 * rows.t[i])));
  }
  EXPECT_LT(value, 1e-4);
  EXPECT_LT(slope, 0.02) << "of 3";
  EXPECT_LT(curvature, 1.0) << "of 9, about a tenth at times as uneven";
  EXPECT_FALSE(channel->at(rows.t[0]).ok) << "ahead of its first sample";
}

TEST(SlowChannel, IsNotOneThatHasAValueInNearlyEveryRow) {
  Rows rows;
  for (std::size_t i = 0; i < rows.t.size(); ++i) rows.y[i] = i % 10 == 3 ? std::nan("") : rows.t[i];
  EXPECT_FALSE(SlowChannel::of(rows.t, rows.y));
}

TEST(SlowChannel, IsNotStretchedOverAGap) {
  Rows rows;
  for (std::size_t i = 800; i < 900; ++i) rows.y[i] = std::nan("");
  const auto channel = SlowChannel::of(rows.t, rows.y);
  ASSERT_TRUE(channel);
  EXPECT_FALSE(channel->at(rows.t[850]).ok);
  EXPECT_TRUE(channel->at(rows.t[950]).ok);
}

}  // namespace
}  // namespace misfit
