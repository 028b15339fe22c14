#include "apps/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <iostream>
#include <memory>

#include "misfit/core/shown.h"

namespace misfit {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds between_lines{200};
constexpr const char* clear_line = "\r\033[K";

std::string time_left(double seconds) {
  if (seconds < 90.0) return fmt::format("{:.0f} s left", std::ceil(seconds));
  if (seconds < 5400.0) return fmt::format("{:.0f} min left", std::ceil(seconds / 60.0));
  return fmt::format("{:.1f} h left", seconds / 3600.0);
}

}  // namespace

Progress::Progress(const std::string& what)
    : what_(printable(what)), visible_(::isatty(STDERR_FILENO) == 1), start_(Clock::now()), last_(start_ - between_lines) {}

Progress::~Progress() {
  if (visible_) fmt::print(stderr, "{}", clear_line);
}

void Progress::update(std::size_t done, std::size_t total) {
  if (!visible_ || total == 0) return;
  if (!before_) before_ = done > 0 ? done - 1 : 0;
  const auto now = Clock::now();
  if (now - last_ < between_lines && done < total) return;
  last_ = now;
  const double part = static_cast<double>(done) / static_cast<double>(total);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const auto now_done = static_cast<double>(done - *before_), to_do = static_cast<double>(total - done);
  const std::string left = done == *before_ ? "" : "  " + time_left(elapsed * to_do / now_done);
  fmt::print(stderr, "{}{}  {:.0f} %{}", clear_line, what_, std::floor(100.0 * part), left);
  std::fflush(stderr);
}

Listener terminal_listener() {
  return {[](const std::string& line) { std::cerr << line << '\n'; },
          [](const std::string& name) -> ProgressFn {
            return [line = std::make_shared<Progress>(name)](std::size_t done, std::size_t total) { line->update(done, total); };
          }};
}

}  // namespace misfit
