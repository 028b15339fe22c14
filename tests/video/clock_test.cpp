#include "misfit/video/clock.h"

#include <gtest/gtest.h>

#include <cmath>

namespace misfit {
namespace {

std::vector<double> times(int count, double rate, double rounded_to = 0.0) {
  std::vector<double> out;
  for (int k = 0; k < count; ++k) {
    const double t = k / rate;
    out.push_back(rounded_to > 0.0 ? rounded_to * std::round(t / rounded_to) : t);
  }
  return out;
}

TEST(FrameClock, TimestampsRoundedToMillisecondsKeepTheDeclaredRate) {
  const FrameClock clock = clock_of(times(2000, 60000.0 / 1001.0, 1e-3), 60000.0 / 1001.0);
  EXPECT_TRUE(clock.constant);
  EXPECT_EQ(clock.rate, 60000.0 / 1001.0);
}

TEST(FrameClock, AFileThatWasCutDeclaresAWrongRateAndItsTimestampsShowTheRightOne) {
  const FrameClock clock = clock_of(times(1844, 60.0, 1.0 / 15360.0), 59.985);
  EXPECT_TRUE(clock.constant);
  EXPECT_NEAR(clock.rate, 60.0, 1e-5);
}

TEST(FrameClock, FramesLeftOutLeaveTheRateAsItIs) {
  std::vector<double> all = times(300, 30.0), some;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (k % 7 != 3) some.push_back(all[k]);
  EXPECT_TRUE(clock_of(some, 30.0).constant);
  const FrameClock wrongly_declared = clock_of(some, 25.7);
  EXPECT_TRUE(wrongly_declared.constant);
  EXPECT_NEAR(wrongly_declared.rate, 30.0, 1e-6);
}

TEST(FrameClock, UnevenIntervalsAreVariable) {
  std::vector<double> uneven;
  for (int k = 0; k < 100; ++k) uneven.push_back(k / 30.0 + 0.008 * std::sin(1.3 * k));
  EXPECT_FALSE(clock_of(uneven, 30.0).constant);
  std::vector<double> slower = times(60, 30.0);  // a telephone whose rate falls with the light
  for (int k = 0; k < 60; ++k) slower.push_back(slower.back() + 1.0 / 24.0);
  EXPECT_FALSE(clock_of(slower, 27.0).constant);
}

TEST(FrameClock, WithoutTimestampsTheDeclaredRateHolds) {
  EXPECT_TRUE(clock_of({}, 25.0).constant);
  EXPECT_EQ(clock_of({0.0}, 25.0).rate, 25.0);
}

/// Over the first hundred frames nothing shows that the rate is wrong.
TEST(FrameNumbers, ARateThatIsALittleWrongLosesNoFrameAndOneThatIsMissingIsSeenToTheEnd) {
  const std::vector<double> all = times(20'000, 29.99, 1e-3);
  for (const double rate : {30.0, 29.98}) {
    FrameNumbers numbers;
    std::size_t wrong = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (k == 15'000) continue;
      wrong += numbers.next(all[k], rate) == static_cast<long>(k) ? 0U : 1U;
    }
    EXPECT_EQ(wrong, 0U) << rate;
  }
}

TEST(FrameNumbers, WithoutATimeFramesFollowEachOther) {
  FrameNumbers numbers;
  EXPECT_EQ(numbers.next({}, 25.0), 0);
  EXPECT_EQ(numbers.next({}, 25.0), 1);
  EXPECT_EQ(numbers.next(0.16, 25.0), 4);
  EXPECT_EQ(numbers.next({}, 25.0), 5);
}

}  // namespace
}  // namespace misfit
