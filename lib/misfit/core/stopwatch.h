#pragma once

#include <chrono>

namespace misfit {

/// Runs from its construction.
class Stopwatch {
 public:
  /// [s]
  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace misfit
