#include "misfit/core/watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

namespace misfit {
namespace {

using testing::HasSubstr;

void sleep_for(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

/// As a loop does.
void work_for_a_while() {
  for (int k = 0; k < 100; ++k) look_at_watch();
}

/// The flag is the process's: as it was at the end of every test.
class WatchTest : public testing::Test {
 protected:
  ~WatchTest() override { interrupted() = false; }
};

TEST_F(WatchTest, NobodyWatchesUnlessAsked) {
  EXPECT_EQ(Watch::current(), nullptr);
  EXPECT_NO_THROW(work_for_a_while());
  EXPECT_NO_THROW(report_iteration(1, "log-likelihood", 2.0));
}

TEST_F(WatchTest, WorkEndsWhenItsTimeIsSpent) {
  const Watch watch("filter_error", 0.01);
  EXPECT_NO_THROW(work_for_a_while());
  EXPECT_FALSE(watch.spent());
  sleep_for(0.02);
  EXPECT_TRUE(watch.spent());
  try {
    work_for_a_while();
    FAIL() << "went on";
  } catch (const TimeLimitReached& spent) {
    EXPECT_STREQ(spent.what(), "the time limit of 0.01 s for filter_error was spent");
    EXPECT_THAT(in_words(spent, "log-likelihood", -12.5), HasSubstr("was spent at a log-likelihood of -12.5: "));
  }
}

TEST_F(WatchTest, OfTwoLimitsThatWhichEndsFirstHolds) {
  const Watch round("this round of discover", 0.01);
  {
    const Watch refit("the refit of overflow", 1000.0);
    EXPECT_THAT(refit.words(), HasSubstr("0.01 s for this round"));
    sleep_for(0.02);
    EXPECT_TRUE(refit.spent());
  }
  EXPECT_EQ(Watch::current(), &round);
  const Watch unlimited("another");
  EXPECT_TRUE(unlimited.spent()) << "no limit of its own: that of the round holds";
}

TEST_F(WatchTest, WhatWasFoundIsWrittenUpUnhurried) {
  const Watch watch("filter_error", 1e-9);
  sleep_for(0.001);
  {
    const SuspendedTimeLimit writing_up;
    EXPECT_NO_THROW(work_for_a_while());
    interrupted() = true;
    EXPECT_THROW(work_for_a_while(), Interrupted) << "an interrupt still holds";
    interrupted() = false;
  }
  EXPECT_THROW(work_for_a_while(), TimeLimitReached);
}

TEST_F(WatchTest, AnInterruptStopsAtTheNextLook) {
  interrupted() = true;
  EXPECT_THROW(look_at_watch(), Interrupted);
  EXPECT_THROW(report_iteration(1, "log-likelihood", 2.0), Interrupted);
}

TEST_F(WatchTest, AThreadThatWorksForAnotherHasItsWatch) {
  const Watch watch("filter_error", 1e-9);
  bool stopped = false;
  std::thread([&, outer = Watch::current()] {
    EXPECT_EQ(Watch::current(), nullptr);
    const SameWatch same(outer);
    try {
      work_for_a_while();
    } catch (const TimeLimitReached&) {
      stopped = true;
    }
  }).join();
  EXPECT_TRUE(stopped);
}

TEST_F(WatchTest, WhoHearsIsToldOfTheSearchesInside) {
  std::vector<SearchState> heard;
  const Watch discover("discover", 0.0, [&](const SearchState& state) { heard.push_back(state); });
  report_iteration(1, "sum of squares", 8.0);
  const Watch refit("the refit of overflow", 100.0);
  report_iteration(3, "log-likelihood", -5.0);
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_EQ(heard[0].work, "discover");
  EXPECT_FALSE(heard[0].left);
  EXPECT_EQ(heard[1].work, "the refit of overflow");
  EXPECT_EQ(heard[1].iteration, 3);
  EXPECT_EQ(heard[1].value, -5.0);
  EXPECT_EQ(heard[1].what, "log-likelihood");
  EXPECT_GT(heard[1].left.value(), 90.0);
}

}  // namespace
}  // namespace misfit
