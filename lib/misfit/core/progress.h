#pragma once

#include <chrono>
#include <cstdio>
#include <optional>
#include <string>

namespace misfit {

/// One line on stderr, "fit  43 %  12 s left", rewritten at most five times a second; silent when stderr is not a terminal or when quiet.
class Progress {
 public:
  Progress(const std::string& what, bool quiet);
  ~Progress();  ///< clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// The time left is told by what was done since the first call: what an earlier run had done took no time in this one.
  void update(std::size_t done, std::size_t total);

 private:
  std::string what_;
  bool visible_;
  std::optional<std::size_t> before_;  ///< done before the first call
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace misfit
