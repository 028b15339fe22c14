#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

namespace misfit {

/// True asks all work of the process to stop. Whoever wants that sets it: a signal handler may (it is lock-free), as may another thread.
[[nodiscard]] std::atomic<bool>& interrupted();

/// Work was stopped from outside. No RunError: whoever makes do without a part that failed must not go on after this.
class Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// interrupted() is true.
class Interrupted : public Stopped {
 public:
  Interrupted();
};

/// A limit of time is spent: what() says which, as "the time limit of 20 s for filter_error was spent".
class TimeLimitReached : public Stopped {
 public:
  using Stopped::Stopped;
};

/// What a fit says that has ended so: `what` is "log-likelihood", `value` where it was.
[[nodiscard]] std::string in_words(const TimeLimitReached& spent, const std::string& what, double value);
/// The same where there was nothing yet: "…, before there was any result".
[[nodiscard]] std::string in_words(const TimeLimitReached& spent);

/// How far a search has come.
struct SearchState {
  int iteration = 0;
  std::string what;  ///< of the value: "log-likelihood"
  double value = 0.0;
  std::string work = {};            ///< what is searched for: Watch::work()
  double seconds = 0.0;             ///< since the work began
  std::optional<double> left = {};  ///< of the limit that ends first [s]; none: there is no limit
};

/// Watches over the work that is done in this thread between its construction and its destruction, and in the threads that run_jobs()
/// starts for it: how long it may take, and who is told how far its searches have come. Watches stand one inside the other; the limit that
/// ends first holds. Deep loops call look_at_watch(), searches report_iteration(), so that neither needs a parameter on the way there.
class Watch {
 public:
  using ProgressCallback = std::function<void(const SearchState&)>;  ///< several threads may call it at once

  /// `limit` [s]; 0: none of its own. Without `on_progress` that of the watch around it is called.
  explicit Watch(std::string work, double limit = 0.0, ProgressCallback on_progress = {});
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  [[nodiscard]] const std::string& work() const { return work_; }
  /// Is a limit that holds here spent?
  [[nodiscard]] bool spent() const;
  /// "the time limit of 20 s for filter_error was spent": of the limit that ends first.
  [[nodiscard]] std::string words() const;

  /// Of this thread; nullptr: nobody watches.
  [[nodiscard]] static const Watch* current();

 private:
  friend class SameWatch;
  friend class SuspendedTimeLimit;
  friend void report_iteration(int iteration, const char* what, double value);
  using Clock = std::chrono::steady_clock;

  std::string work_;
  double limit_;
  ProgressCallback on_progress_;
  const Watch* outer_;
  Clock::time_point begin_ = Clock::now();
  std::optional<Clock::time_point> end_;
  const Watch* first_ = nullptr;  ///< whose limit ends first, this one or one around it
};

/// Gives a thread the watch of the one that it works for.
class SameWatch {
 public:
  explicit SameWatch(const Watch* watch);
  ~SameWatch();
  SameWatch(const SameWatch&) = delete;
  SameWatch& operator=(const SameWatch&) = delete;

 private:
  const Watch* before_;
};

/// As long as it lives no limit of time holds in this thread: for writing up what was found until then. An interrupt still does.
class SuspendedTimeLimit {
 public:
  SuspendedTimeLimit();
  ~SuspendedTimeLimit();
  SuspendedTimeLimit(const SuspendedTimeLimit&) = delete;
  SuspendedTimeLimit& operator=(const SuspendedTimeLimit&) = delete;

 private:
  std::optional<Watch> watch_;
};

/// In every loop over samples or steps: throws Interrupted, TimeLimitReached. Costs a few nanoseconds; the clock is read at every 32nd
/// call.
void look_at_watch();
/// An iteration of a search has ended: reported to whoever listens; ends the search as look_at_watch() does.
void report_iteration(int iteration, const char* what, double value);

}  // namespace misfit
