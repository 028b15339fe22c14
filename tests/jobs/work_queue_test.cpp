#include "misfit/jobs/work_queue.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "misfit/core/watch.h"

namespace misfit {
namespace {

std::vector<double> filled(int threads) {
  std::vector<double> slots(500, -1.0);
  EXPECT_TRUE(run_jobs(slots.size(), threads, [&](std::size_t k) { slots[k] = std::sin(static_cast<double>(k)); }));
  return slots;
}

TEST(RunJobs, AnswerDoesNotDependOnTheNumberOfThreads) {
  const std::vector<double> one = filled(1);
  EXPECT_EQ(one[499], std::sin(499.0));
  EXPECT_EQ(filled(4), one);
  EXPECT_EQ(filled(0), one);
}

TEST(RunJobs, RunsAtTheSameTimeOnSeveralThreads) {
  std::atomic<int> waiting{0};
  const auto meet = [&](std::size_t) {
    ++waiting;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (waiting < 3 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    if (waiting < 3) throw std::runtime_error("the other jobs did not start");
  };
  EXPECT_TRUE(run_jobs(3, 3, meet));
}

TEST(RunJobs, NoJobsAreDoneAtOnce) {
  EXPECT_TRUE(run_jobs(0, 4, [](std::size_t) { FAIL(); }));
}

std::string rethrown(int threads) {
  try {
    run_jobs(200, threads, [](std::size_t k) {
      if (k == 20) std::this_thread::sleep_for(std::chrono::milliseconds(30));  // the later one throws first
      if (k >= 20) throw std::runtime_error(std::to_string(k));
    });
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

TEST(RunJobs, JobsHaveTheWatchOfWhoCalls) {
  const Watch watch("all of it", 1000.0);
  std::atomic<int> watched{0};
  EXPECT_TRUE(run_jobs(50, 3, [&](std::size_t) { watched += Watch::current() == &watch ? 1 : 0; }));
  EXPECT_EQ(watched, 50);
}

TEST(RunJobs, AnInterruptedJobWasNotBegunWhereWorkCanBeStopped) {
  std::atomic<bool> stop{false};
  const auto job = [&](std::size_t k) {
    if (k < 3) return;
    stop = true;
    throw Interrupted();
  };
  std::size_t done = 0;
  EXPECT_FALSE(run_jobs(
      10, 1, job, [&](std::size_t now, std::size_t) { done = now; }, &stop));
  EXPECT_EQ(done, 3U);
  EXPECT_THROW(run_jobs(10, 1, job), Interrupted);
}

TEST(RunJobs, RethrowsTheExceptionOfTheLowestJob) {
  EXPECT_EQ(rethrown(1), "20");
  EXPECT_EQ(rethrown(4), "20");
}

TEST(RunJobs, AnExceptionStopsTheRest) {
  std::atomic<int> ran{0};
  const auto job = [&](std::size_t k) {
    ++ran;
    if (k == 3) throw std::runtime_error("x");
  };
  EXPECT_THROW(run_jobs(1000, 1, job), std::runtime_error);
  EXPECT_EQ(ran, 4);
}

TEST(RunJobs, TheStopFlagEndsEarly) {
  for (const int threads : {1, 4}) {
    std::atomic<bool> stop{false};
    std::atomic<std::size_t> ran{0};
    const bool all = run_jobs(
        1000, threads,
        [&](std::size_t k) {
          ++ran;
          if (k == 10) stop = true;
        },
        {}, &stop);
    EXPECT_FALSE(all);
    EXPECT_GE(ran, 11U);
    EXPECT_LT(ran, 1000U);
  }
}

TEST(RunJobs, AStopAfterTheLastJobIsNoStop) {
  std::atomic<bool> stop{false};
  EXPECT_TRUE(run_jobs(
      3, 1, [&](std::size_t k) { stop = k == 2; }, {}, &stop));
}

TEST(RunJobs, ProgressCountsEveryJobOnceInOrder) {
  std::vector<std::size_t> seen;
  std::vector<int> unused(100);
  run_jobs(
      100, 4, [&](std::size_t k) { unused[k] = 1; },
      [&](std::size_t done, std::size_t total) {
        EXPECT_EQ(total, 100U);
        seen.push_back(done);
      });
  ASSERT_EQ(seen.size(), 100U);
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], i + 1);
}

}  // namespace
}  // namespace misfit
