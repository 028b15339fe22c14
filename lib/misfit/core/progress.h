#pragma once

#include <chrono>
#include <cstdio>
#include <string>

namespace misfit {

/// One line on stderr, "fit  43 %  12 s left", rewritten at most five times a second; silent when stderr is not a terminal or when quiet.
class Progress {
 public:
  Progress(std::string what, bool quiet);
  ~Progress();  ///< clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::size_t done, std::size_t total);

 private:
  std::string what_;
  bool visible_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace misfit
