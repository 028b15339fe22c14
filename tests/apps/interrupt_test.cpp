// Ctrl-C in the midst of long work: answered at once, over within a second or two, and the same command goes on to the same results.
#include <gmock/gmock.h>

#include <csignal>
#include <thread>

#include "tests/apps/oscillator_study.h"
#include "tests/apps/short_flight.h"

namespace {

using namespace program;
using std::chrono::steady_clock;
using testing::HasSubstr;

double seconds_since(steady_clock::time_point begin) { return std::chrono::duration<double>(steady_clock::now() - begin).count(); }

/// Waits until `arrived`, for a slow machine with sanitizers nearly as long as a test may take; false: it did not come.
bool wait_for(const std::function<bool()>& arrived) {
  constexpr double most = 500.0;  // [s]
  const auto begin = steady_clock::now();
  while (!arrived()) {
    if (seconds_since(begin) > most) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

struct Stopped {
  Outcome outcome;
  double answered = 0.0, ended = 0.0;  ///< [s] after the signal
};

/// Starts the command, waits until `arrived` and `more` seconds longer, and sends the signal.
Stopped stopped(const std::vector<std::string>& command, const std::function<bool()>& arrived, double more, int signal = SIGINT) {
  const TemporaryFolder captured;
  const pid_t child = start(captured.path(), command);
  EXPECT_TRUE(wait_for(arrived));
  std::this_thread::sleep_for(std::chrono::duration<double>(more));
  const auto begin = steady_clock::now();
  ::kill(child, signal);
  Stopped out;
  EXPECT_TRUE(wait_for([&] { return content(captured.path() / "stderr").find("misfit: stopping") != std::string::npos; }));
  out.answered = seconds_since(begin);
  out.outcome = finish(captured.path(), child);
  out.ended = seconds_since(begin);
  return out;
}

/// What a machine on which much else goes on may take.
constexpr double soon = 1.0, at_the_end = 5.0;

void expect_stopped(const Stopped& stopped) {
  EXPECT_EQ(stopped.outcome.status, 1) << stopped.outcome.out << stopped.outcome.err;
  EXPECT_THAT(stopped.outcome.err, HasSubstr("misfit: interrupted; finished work is kept in the run folder"));
  EXPECT_LT(stopped.answered, soon);
  EXPECT_LT(stopped.ended, at_the_end);
}

/// A long record, so that one sweep of the filter takes a good part of a second.
class LongFlight : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> words(const std::string& verb) const {
    return {verb, study_.path("study.toml").string(), "--out", study_.path("out").string(), "--threads", "2", "--quiet"};
  }
  [[nodiscard]] bool exists(const std::string& name) const { return fs::exists(study_.path("out") / name); }

  const ShortFlight study_{"parachute_spherical", 79.0};
};

TEST_F(LongFlight, InTheMiddleOfAFit) {
  const auto begun = [&] { return exists("resolved.toml"); };
  expect_stopped(stopped(words("fit"), begun, 1.5));
  EXPECT_FALSE(exists("fit/filter_error/fit.json"));
  expect_stopped(stopped(words("fit"), begun, 0.5, SIGTERM));
}

TEST_F(LongFlight, InTheMiddleOfAScreening) {
  const Stopped in_screening = stopped(
      words("discover"), [&] { return exists("fit/filter_error/fit.json"); }, 0.5);
  expect_stopped(in_screening);
  EXPECT_TRUE(exists("fit/filter_error/fit.json")) << "what was finished is kept";
  EXPECT_FALSE(exists("candidates.json"));
}

class InRefits : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> words(const std::string& out) const {
    return {"discover", study_.path("study.toml").string(), "--out", study_.path(out).string(), "--threads", "1"};
  }
  const OscillatorStudy study_;
};

TEST_F(InRefits, GoesOnToTheSameAnswer) {
  const Outcome whole = program::run(words("whole"));
  ASSERT_EQ(whole.status, 0) << whole.err;
  const fs::path refits = study_.path("stopped") / "discover_refits" / "checkpoint_0.bin";
  expect_stopped(stopped(
      words("stopped"), [&] { return fs::exists(refits); }, 0.3));
  EXPECT_TRUE(fs::exists(refits));
  const Outcome again = program::run(words("stopped"));
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(content(study_.path("stopped") / "candidates.json"), content(study_.path("whole") / "candidates.json"));
}

TEST(TimeLimitOption, EndsAFitWithWhatItHas) {
  const ShortFlight study{"parachute_spherical", 60.0};
  const Outcome cut = program::run(
      {"fit", study.path("study.toml").string(), "--out", study.path("cut").string(), "--method", "filter_error", "--time-limit", "0.5"});
  const json fit = json::parse(content(study.path("cut") / "fit/filter_error/fit.json"));
  EXPECT_NE(fit.at("status"), "converged");
  EXPECT_THAT(fit.at("message").get<std::string>(), HasSubstr("the time limit of 0.5 s for filter_error was spent"));
  EXPECT_THAT(cut.out, HasSubstr("the time limit of 0.5 s"));
}

TEST(TimeLimitOption, RefusesWhatIsNoTime) {
  const ShortFlight study{"parachute_spherical", 5.0};
  for (const char* wrong : {"0", "-3", "nan", "10s"}) {
    const Outcome refused = program::run({"fit", study.path("study.toml").string(), std::string("--time-limit=") + wrong});
    EXPECT_EQ(refused.status, 2) << wrong;
    EXPECT_THAT(refused.err, HasSubstr("a number of seconds above 0 is expected")) << wrong;
  }
}

TEST(TimeLimitKey, IsThatOfEveryFit) {
  const OscillatorStudy study;
  const std::string text = content(study.path("study.toml"));
  study.write("study.toml", text + "[fit]\ntime_limit = 1e-6\n");
  const Outcome cut = program::run({"fit", study.path("study.toml").string(), "--out", study.path("cut").string()});
  for (const char* method : {"output_error", "filter_error"}) {
    const json fit = json::parse(content(study.path("cut") / "fit" / method / "fit.json"));
    EXPECT_THAT(fit.at("message").get<std::string>(), HasSubstr("the time limit of 1e-06 s")) << method;
  }
  study.write("study.toml", text + "[fit]\ntime_limit = 0\n");
  const Outcome refused = program::run({"fit", study.path("study.toml").string(), "--out", study.path("refused").string()});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("time_limit"));
}

}  // namespace
