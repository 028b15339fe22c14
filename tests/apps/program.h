#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "tests/core/temporary_folder.h"
#include "tests/paths.h"

/// Runs the built program on copies of the shipped studies.
namespace program {

namespace fs = std::filesystem;
using nlohmann::json;

struct Outcome {
  int status = -1;  ///< exit status; -1 if a signal ended it
  std::string out, err;
  double seconds = 0.0;
};

inline std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_TRUE(file.good()) << path << " cannot be read";
  return text.str();
}

/// Starts misfit with stdout and stderr going to files of `folder`; `before` is called in the child.
inline pid_t start(
    const fs::path& folder, std::vector<std::string> arguments, const std::function<void()>& before = [] {}) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  for (const auto& [name, number] : {std::pair{"stdout", STDOUT_FILENO}, std::pair{"stderr", STDERR_FILENO}})
    ::dup2(::open((folder / name).c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), number);
  before();
  std::vector<char*> argv;
  arguments.insert(arguments.begin(), paths::program().string());
  for (auto& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

inline Outcome finish(const fs::path& folder, pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(folder / "stdout"), content(folder / "stderr")};
}

inline Outcome run(
    const std::vector<std::string>& arguments, const std::function<void()>& before = [] {}) {
  const TemporaryFolder captured;
  const auto begin = std::chrono::steady_clock::now();
  Outcome outcome = finish(captured.path(), start(captured.path(), arguments, before));
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return outcome;
}

inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells{""};
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back().push_back(c);
    }
  }
  return cells;
}

/// A copy of configs/NAME without its results, to be changed and run.
class StudyCopy {
 public:
  explicit StudyCopy(const std::string& name) {
    for (const auto& entry : fs::directory_iterator(paths::source() / "configs" / name))
      if (entry.is_regular_file()) fs::copy_file(entry.path(), path(entry.path().filename().string()));
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] fs::path out(const std::string& name) const { return folder_.path() / "out" / name; }
  [[nodiscard]] Outcome run(const std::string& verb = "run", const std::vector<std::string>& options = {}) const {
    std::vector<std::string> arguments{verb, path("study.toml").string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return program::run(arguments);
  }
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  /// Replaces the first match in study.toml; a test that changes nothing would prove nothing.
  void change(const std::string& pattern, const std::string& by) const {
    const std::string before = content(path("study.toml"));
    const std::string after = std::regex_replace(before, std::regex(pattern), by, std::regex_constants::format_first_only);
    EXPECT_NE(before, after) << pattern;
    write("study.toml", after);
  }
  /// mpf_f111 from its track instead of its video: the same flight, without the seconds that tracking takes.
  void start_from_track() const { change("video = \"flight.mkv\"", "track = \"track.csv\""); }
  void append(const std::string& text) const { write("study.toml", content(path("study.toml")) + text); }
  /// Every line of a CSV but the header goes through `change`; an empty result drops the line.
  void change_rows(const std::string& name, const std::function<std::string(std::size_t, const std::vector<std::string>&)>& change) const {
    std::istringstream lines(content(path(name)));
    std::string text, line;
    for (std::size_t row = 0; std::getline(lines, line); ++row) {
      if (row > 0) line = change(row, cells_of(line));
      if (row == 0 || !line.empty()) text += line + "\n";
    }
    write(name, text);
  }
  [[nodiscard]] json result(const std::string& name) const { return json::parse(content(out(name))); }
  [[nodiscard]] json fit(const std::string& method) const { return result("fit/" + method + "/fit.json"); }

 private:
  TemporaryFolder folder_;
};

struct CurvePoint {
  double x, value, sigma, count;
};

/// The rows of curves.csv that belong to `curve`.
inline std::vector<CurvePoint> curve_points(const fs::path& file, const std::string& curve) {
  std::vector<CurvePoint> points;
  std::istringstream lines(content(file));
  std::string line;
  while (std::getline(lines, line)) {
    if (!line.starts_with(curve + ",")) continue;
    for (char& c : line)
      if (c == ',') c = ' ';
    std::istringstream cells(line.substr(curve.size()));
    CurvePoint p{};
    if (cells >> p.x >> p.value >> p.sigma >> p.count) points.push_back(p);
  }
  return points;
}

inline std::string first_line(const fs::path& file) {
  const std::string text = content(file);
  return text.substr(0, text.find('\n'));
}

}  // namespace program
