#pragma once

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

}  // namespace program
