#pragma once

#include <chrono>
#include <cstdio>
#include <mutex>
#include <optional>
#include <string>

#include "misfit/workflow/session/session.h"

namespace misfit {

/// One line on stderr, "fit  43 %  12 s left", rewritten at most five times a second; silent when stderr is not a terminal.
class Progress {
 public:
  explicit Progress(const std::string& what);
  ~Progress();  ///< clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// The remaining time is estimated from the work done since the first call: work of an earlier run took no time in this one.
  void update(std::size_t done, std::size_t total);
  /// "filter_error  iteration 7, log-likelihood -1234.5, 3 s, at most 57 s left": several threads may call it at once.
  void update(const SearchState& state);

 private:
  /// nullopt: the last line is too young.
  [[nodiscard]] std::optional<double> due(bool at_once);

  std::string what_;
  bool visible_;
  std::mutex mutex_;
  std::optional<std::size_t> before_;  ///< done before the first call
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_;
};

/// What is printed next begins on a line of its own, also where a line of progress stands.
void clear_progress_line();

/// Notes as lines on stderr, progress as a line that is rewritten there.
[[nodiscard]] Listener terminal_listener();

}  // namespace misfit
