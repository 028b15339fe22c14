#include "apps/progress.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <thread>

namespace misfit {
namespace {

/// Stands a terminal behind stderr for its lifetime.
class Terminal {
 public:
  Terminal() : master_(::posix_openpt(O_RDWR | O_NOCTTY)), saved_(::dup(STDERR_FILENO)) {
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) return;
    const int slave = ::open(::ptsname(master_), O_RDWR | O_NOCTTY);
    if (slave < 0) return;
    ::dup2(slave, STDERR_FILENO);
    ::close(slave);
    works_ = true;
  }
  ~Terminal() {
    ::dup2(saved_, STDERR_FILENO);
    ::close(saved_);
    if (master_ >= 0) ::close(master_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  [[nodiscard]] bool works() const { return works_; }
  [[nodiscard]] std::string shown() const {
    std::string out;
    pollfd ready{master_, POLLIN, 0};
    char buffer[256];
    while (::poll(&ready, 1, 100) > 0 && (ready.revents & POLLIN) != 0) {
      const ssize_t n = ::read(master_, buffer, sizeof buffer);
      if (n <= 0) break;
      out.append(buffer, static_cast<std::size_t>(n));
    }
    return out;
  }

 private:
  int master_, saved_;
  bool works_ = false;
};

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// Where the machine gives no pseudo-terminal there is nothing to look at.
class ProgressOnATerminal : public testing::Test {
 protected:
  void SetUp() override {
    if (!terminal.works()) GTEST_SKIP() << "no pseudo-terminal";
  }
  const Terminal terminal;
};

TEST_F(ProgressOnATerminal, ShowsPartAndTimeLeftAndClearsTheLine) {
  {
    Progress progress("fit");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    progress.update(1, 4);
  }
  EXPECT_EQ(terminal.shown(), "\r\033[Kfit  25 %  1 s left\r\033[K");
}

TEST_F(ProgressOnATerminal, WhatAnEarlierRunHadDoneDoesNotShortenTheTimeLeft) {
  Progress progress("fit");
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  progress.update(901, 1000);
  const std::string text = terminal.shown();
  EXPECT_EQ(count(text, "90 %"), 1U) << text;
  EXPECT_EQ(count(text, "  1 s left"), 0U) << "one job in 20 ms, 99 to go: " << text;
}

TEST_F(ProgressOnATerminal, WritesAtMostFiveTimesASecond) {
  const auto start = std::chrono::steady_clock::now();
  Progress progress("fit");
  for (std::size_t i = 1; i < 1000; ++i) progress.update(i, 1000);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::size_t lines = count(terminal.shown(), "fit");
  EXPECT_GE(lines, 1U);
  EXPECT_LE(static_cast<double>(lines), 1.0 + 5.0 * seconds);
}

TEST_F(ProgressOnATerminal, TheListenerClearsTheLineWhenTheWorkHasEnded) {
  { terminal_listener().progress("fit")(4, 4); }
  EXPECT_EQ(terminal.shown(), "\r\033[Kfit  100 %  0 s left\r\033[K");
}

TEST_F(ProgressOnATerminal, ShowsIterationCostAndTimeOfASearch) {
  terminal_listener().searches("filter_error")({7, "log-likelihood", -1234.5, "filter_error", 3.2, 57.0});
  EXPECT_EQ(terminal.shown(), "\r\033[Kfilter_error  iteration 7, log-likelihood -1234.5, 3 s, at most 57 s left\r\033[K");
  terminal_listener().searches("fit")({8, "sum of squares", 0.25, "output_error", 95.0, {}});
  EXPECT_EQ(terminal.shown(), "\r\033[Koutput_error  iteration 8, sum of squares 0.25, 95 s\r\033[K") << "no limit, no time left";
}

TEST(Progress, IsSilentWhereThereIsNoTerminal) {
  ::testing::internal::CaptureStderr();
  { Progress("fit").update(1, 4); }
  terminal_listener().searches("fit")({8, "sum of squares", 0.25, "output_error", 95.0, {}});
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace misfit
