#pragma once

#include <csignal>
#include <thread>

#include "tests/apps/program.h"

namespace program {

/// The first seconds of configs/mpf_f111 as a study for filter_error.
class ShortFlight : public StudyCopy {
 public:
  explicit ShortFlight(const std::string& system = "parachute_spherical", double seconds = 20.0) : StudyCopy("mpf_f111") {
    if (system != "parachute_planar") change("parachute_planar", system);
    change("methods = .*", "methods = [\"filter_error\"]");
    change("\nvideo = .*", "\ntrack = \"track.csv\"\nvalidation = \"last 25 %\"");
    constexpr double rate = 59.94;
    const auto rows = static_cast<std::size_t>(seconds * rate);
    keep_rows("track.csv", rows);
  }

  void keep_rows(const std::string& name, std::size_t rows) const {
    std::istringstream lines(content(path(name)));
    std::string text, line;
    for (std::size_t row = 0; row <= rows && std::getline(lines, line); ++row) text += line + "\n";
    write(name, text);
  }

  [[nodiscard]] Outcome add(const std::string& effect, const std::vector<std::string>& options = {}) const {
    std::vector<std::string> arguments{"add", path("study.toml").string(), effect};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return program::run(arguments);
  }
};

/// The first seconds of configs/validation.
class ShortValidation : public StudyCopy {
 public:
  explicit ShortValidation(std::size_t rows = 900) : StudyCopy("validation") {
    change_rows("alpha_history.csv", [rows](std::size_t row, const auto& c) { return row <= rows ? c[0] + "," + c[1] + "," + c[2] : ""; });
  }
  [[nodiscard]] Outcome uncertainty(const std::vector<std::string>& options) const { return run("uncertainty", options); }
};

/// [bytes] 0 if it is not there.
inline std::uintmax_t size_of(const fs::path& file) {
  std::error_code none;
  const std::uintmax_t size = fs::file_size(file, none);
  return none ? 0 : size;
}

/// Starts misfit, kills it with SIGKILL as soon as `file` has more than `bytes`, and returns the size that it left. Without `bytes`: after
/// that many milliseconds.
inline std::uintmax_t killed_at(const std::vector<std::string>& arguments, const fs::path& file, std::uintmax_t bytes,
                                int milliseconds = 0) {
  const TemporaryFolder captured;
  const pid_t child = start(captured.path(), arguments);
  constexpr int longest = 600'000;
  for (int waited = 0; waited < (milliseconds > 0 ? milliseconds : longest); ++waited) {
    if (milliseconds == 0 && size_of(file) > bytes) break;
    if (milliseconds == 0 && ::waitpid(child, nullptr, WNOHANG) == child) return size_of(file);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ::kill(child, SIGKILL);
  (void)finish(captured.path(), child);
  return size_of(file);
}

/// Length of the head of a checkpoint: what is behind it are jobs that are done.
inline std::uintmax_t checkpoint_head(const fs::path& file) { return first_line(file).size() + 1; }

}  // namespace program
