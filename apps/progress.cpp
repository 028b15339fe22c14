#include "apps/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "misfit/core/shown.h"

namespace misfit {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds between_lines{200}, between_lines_for_the_page{30};
/// MISFIT_PROGRESS=lines: for the page of `misfit open`, which starts this program (serve/job.cpp reads them).
bool as_lines() {
  static const bool lines = [] {
    const char* asked = std::getenv("MISFIT_PROGRESS");
    return asked != nullptr && std::string_view(asked) == "lines";
  }();
  return lines;
}

void print_line(const nlohmann::ordered_json& progress) {
  fmt::print(stderr, "{}\n", progress.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

constexpr const char* clear_line = "\r\033[K";

std::string time_left(double seconds) {
  if (seconds < 90.0) return fmt::format("{:.0f} s left", std::ceil(seconds));
  if (seconds < 5400.0) return fmt::format("{:.0f} min left", std::ceil(seconds / 60.0));
  return fmt::format("{:.1f} h left", seconds / 3600.0);
}

}  // namespace

Progress::Progress(const std::string& what)
    : what_(printable(what)), visible_(as_lines() || ::isatty(STDERR_FILENO) == 1), start_(Clock::now()), last_(start_ - between_lines) {}

Progress::~Progress() {
  if (visible_ && !as_lines()) fmt::print(stderr, "{}", clear_line);
}

void Progress::update(std::size_t done, std::size_t total) {
  if (!visible_ || total == 0) return;
  if (!before_) before_ = done > 0 ? done - 1 : 0;
  const std::optional<double> elapsed = due(done >= total);
  if (!elapsed) return;
  const double part = static_cast<double>(done) / static_cast<double>(total);
  const auto now_done = static_cast<double>(done - *before_), to_do = static_cast<double>(total - done);
  if (as_lines()) return print_line({{"progress", what_}, {"part", part}});
  const std::string left = done == *before_ ? "" : "  " + time_left(*elapsed * to_do / now_done);
  fmt::print(stderr, "{}{}  {:.0f} %{}", clear_line, what_, std::floor(100.0 * part), left);
  std::fflush(stderr);
}

void Progress::update(const SearchState& state) {
  if (!visible_) return;
  const std::lock_guard lock(mutex_);
  if (!due(false)) return;
  if (as_lines()) {
    return print_line({{"progress", state.work},
                       {"iteration", state.iteration},
                       {"what", state.what},
                       {"value", state.value},
                       {"left", state.left ? nlohmann::ordered_json(*state.left) : nlohmann::ordered_json()}});
  }
  const std::string left = state.left ? ", at most " + time_left(*state.left) : "";
  fmt::print(stderr, "{}{}  iteration {}, {} {:.8g}, {:.0f} s{}", clear_line, printable(state.work), state.iteration, state.what,
             state.value, std::floor(state.seconds), left);
  std::fflush(stderr);
}

std::optional<double> Progress::due(bool at_once) {
  const auto now = Clock::now();
  if (now - last_ < (as_lines() ? between_lines_for_the_page : between_lines) && !at_once) return std::nullopt;
  last_ = now;
  return std::chrono::duration<double>(now - start_).count();
}

void clear_progress_line() {
  if (::isatty(STDERR_FILENO) != 1) return;
  fmt::print(stderr, "{}", clear_line);
  std::fflush(stderr);
}

Listener terminal_listener() {
  return {[said = std::make_shared<std::set<std::string>>()](const std::string& line) {
            if (!said->insert(line).second) return;  // as before, of another fit of the same data
            clear_progress_line();
            std::cerr << line << '\n';
          },
          [](const std::string& name) -> ProgressFn {
            return [line = std::make_shared<Progress>(name)](std::size_t done, std::size_t total) { line->update(done, total); };
          },
          [](const std::string& name) -> Watch::ProgressCallback {
            return [line = std::make_shared<Progress>(name)](const SearchState& state) { line->update(state); };
          }};
}

}  // namespace misfit
