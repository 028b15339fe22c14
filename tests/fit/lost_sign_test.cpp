#include "misfit/fit/regression/lost_sign.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/fit/rectified.h"

namespace misfit {
namespace {

using testing_rectified::motor;

/// Of the samples farther from zero than its noise, those whose sign is that of the true one.
double share_right(const Signals& with_signs, const Signals& truth) {
  constexpr double clear = 2.0;
  double right = 0.0, all = 0.0;
  for (std::size_t k = 2; k < truth.samples(); ++k) {
    const double w = truth.measured[0].values[k], found = with_signs.measured[0].values[k];
    if (std::abs(w) < clear || !std::isfinite(found)) continue;
    all += 1.0;
    right += (w > 0.0) == (found > 0.0) ? 1.0 : 0.0;
  }
  return right / all;
}

TEST(AnOutputWithoutItsSign, GetsItBack) {
  for (const double w0 : {40.0, -40.0}) {
    for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
      const auto record = with_signs({motor(true, w0, seed)}, "w");
      ASSERT_TRUE(record) << seed;
      EXPECT_LT(record->left, 0.4) << seed;
      EXPECT_GT(record->changes, 2) << seed;
      EXPECT_GT(share_right(record->experiments.front(), motor(false, w0, seed)), 0.98) << seed;
    }
  }
}

TEST(AnOutputWithoutItsSign, GetsItBackBesideMissingSamplesAndInAnotherRecording) {
  Signals first = motor(true, 40.0, 6);
  for (std::size_t k = 300; k < 320; ++k) first.measured[0].values[k] = std::numeric_limits<double>::quiet_NaN();
  const auto record = with_signs({first, motor(true, -30.0, 7)}, "w");
  ASSERT_TRUE(record);
  EXPECT_TRUE(std::isnan(record->experiments[0].measured[0].values[310]));
  EXPECT_GT(share_right(record->experiments[0], motor(false, 40.0, 6)), 0.98);
  EXPECT_GT(share_right(record->experiments[1], motor(false, -30.0, 7)), 0.98);
}

TEST(AnOutputWithoutItsSign, GetsItBackBesideAnInputThatWasNotRecordedWhole) {
  Signals record = motor(true, 40.0, 13);
  record.inputs.insert(record.inputs.begin(), {"lamp", "V", {}, 0.0});
  const auto found = with_signs({record}, "w");
  ASSERT_TRUE(found);
  EXPECT_GT(share_right(found->experiments.front(), motor(false, 40.0, 13)), 0.98);
}

TEST(AnOutputWithItsSign, IsLeft) { EXPECT_FALSE(with_signs({motor(false, 40.0, 8)}, "w")); }

TEST(AnOutputThatIsPositive, IsLeft) {
  Signals above = motor(false, 40.0, 9);
  for (double& w : above.measured[0].values) w += 100.0;
  EXPECT_FALSE(with_signs({above}, "w"));
}

/// Nothing but rounding is left of it, with any signs.
TEST(AnOutputThatIsPositiveWithoutNoise, IsLeft) {
  Signals decay = motor(false, 40.0, 14, 0.0);
  for (std::size_t k = 0; k < decay.samples(); ++k) decay.measured[0].values[k] = 50.0 * std::exp(-0.1 * decay.t[k]);
  EXPECT_FALSE(with_signs({decay}, "w"));
}

TEST(AnOutputThatEndsAtZero, IsLeft) {
  Signals ends = motor(false, 40.0, 10, 0.0);
  for (double& w : ends.measured[0].values) w = std::max(w, 0.0);
  EXPECT_FALSE(with_signs({ends}, "w"));
}

/// A rate that is squared: smooth where it comes to zero.
TEST(AnOutputThatTouchesZeroSmoothly, IsLeft) {
  Signals squared = motor(false, 40.0, 11);
  for (std::size_t k = 0; k < squared.samples(); ++k)
    squared.measured[0].values[k] = 10.0 * (1.0 + std::sin(2.0 * std::numbers::pi * 0.7 * squared.t[k]));
  EXPECT_FALSE(with_signs({squared}, "w"));
}

TEST(AnOutputThatIsNotMeasured, IsLeft) { EXPECT_FALSE(with_signs({motor(true, 40.0, 12)}, "speed")); }

}  // namespace
}  // namespace misfit
