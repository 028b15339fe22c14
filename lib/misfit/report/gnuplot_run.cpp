// The only includer of gnuplot-iostream (it costs seconds and pulls in Boost).
#include "misfit/report/gnuplot_run.h"

#include <fmt/format.h>
#include <gnuplot-iostream.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <system_error>

#include "misfit/core/error.h"
#include "misfit/core/files.h"

namespace misfit::report {
namespace {

namespace fs = std::filesystem;

/// gnuplot may end before it has read all we write; that must be an error in words, not the end of the program.
class IgnoreBrokenPipe {
 public:
  IgnoreBrokenPipe() : before_(std::signal(SIGPIPE, SIG_IGN)) {}
  ~IgnoreBrokenPipe() { std::signal(SIGPIPE, before_); }
  IgnoreBrokenPipe(const IgnoreBrokenPipe&) = delete;
  IgnoreBrokenPipe& operator=(const IgnoreBrokenPipe&) = delete;

 private:
  void (*before_)(int);
};

std::optional<fs::path> find_program(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  std::string folder;
  while (std::getline(folders, folder, ':')) {
    const fs::path candidate = fs::path(folder.empty() ? "." : folder) / program;
    std::error_code ignored;
    if (fs::is_regular_file(candidate, ignored) && ::access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return std::nullopt;
}

std::string replace_all(const std::string& text, const std::string& from, const std::string& to) {
  std::string result;
  std::size_t begin = 0;
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, begin)) {
    result += text.substr(begin, at - begin) + to;
    begin = at + from.size();
  }
  return result + text.substr(begin);
}

std::string shell_quoted(const std::string& text) { return fmt::format("'{}'", replace_all(text, "'", "'\\''")); }

/// Printed if the script came to its end, where it sets `drawn`: gnuplot closes its drawing properly, and reads on, when a command fails.
constexpr const char* all_drawn = "misfit: all drawn";

bool complete_drawing(const fs::path& path, const std::string& words) {
  std::error_code ignored;
  if (words.find(all_drawn) == std::string::npos || !fs::is_regular_file(path, ignored)) return false;
  const std::string text = read_file(path);
  return text.find("</svg>", text.size() < 64 ? 0 : text.size() - 64) != std::string::npos;
}

std::string words_of(const fs::path& log) {
  std::error_code ignored;
  if (!fs::is_regular_file(log, ignored)) return "it says nothing";
  const std::string text = read_file(log);
  const std::size_t end = text.find_last_not_of(" \n\r\t");
  return end == std::string::npos ? "it says nothing" : text.substr(0, end + 1);
}

}  // namespace

void run_gnuplot(const fs::path& dir, const std::string& name) {
  const std::optional<fs::path> program = find_program("gnuplot");
  if (!program)
    throw RunError("gnuplot is not installed (not on the PATH): the figures cannot be drawn; their .csv and .gp files are in " +
                   dir.string());
  const fs::path part = dir / ("." + name + ".svg.part");
  const fs::path log = dir / ("." + name + ".log");
  std::error_code ignored;
  fs::remove(part, ignored);
  {
    const IgnoreBrokenPipe guard;
    Gnuplot gnuplot(fmt::format("cd {} && {} >{} 2>&1 || true", shell_quoted(dir.string()), shell_quoted(fs::absolute(*program).string()),
                                shell_quoted(log.filename().string())));
    gnuplot << fmt::format("out = '{}'\nload '{}.gp'\nif (exists('drawn')) print '{}'\n", part.filename().string(), name, all_drawn);
  }
  const std::string words = words_of(log);
  fs::remove(log, ignored);
  if (!complete_drawing(part, words)) {
    fs::remove(part, ignored);
    throw RunError("gnuplot failed on " + (dir / (name + ".gp")).string() + ": " + words);
  }
  std::error_code failed;
  fs::rename(part, dir / (name + ".svg"), failed);
  if (failed) throw RunError((dir / (name + ".svg")).string() + ": " + failed.message());
}

}  // namespace misfit::report
