// The only includer of gnuplot-iostream (it costs seconds and pulls in Boost).
#include "misfit/report/gnuplot_run.h"

#include <fmt/format.h>
#include <gnuplot-iostream.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <deque>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/report/symbols.h"
#include "misfit/report/unbroken.h"

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

/// A file in memory that a program we start can write under path(): what gnuplot draws and says does not depend on room on the disk, and
/// leaves nothing behind if the program is killed.
class MemoryFile {
 public:
  explicit MemoryFile(const char* name) : number_(::memfd_create(name, 0)) {
    if (number_ < 0) throw RunError(std::string("no file in memory can be opened for gnuplot: ") + std::generic_category().message(errno));
  }
  ~MemoryFile() { ::close(number_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// Of the file in a program that was started from here.
  [[nodiscard]] std::string path() const { return fmt::format("/proc/self/fd/{}", number_); }

  [[nodiscard]] std::string text() const {
    std::string out;
    std::array<char, 1 << 16> buffer{};
    for (;;) {
      const ssize_t n = ::pread(number_, buffer.data(), buffer.size(), std::ssize(out));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return out;
      out.append(buffer.data(), n);
    }
  }

 private:
  int number_;
};

/// Printed if a script came to its end, where it sets `drawn`: gnuplot closes its drawing properly, and reads on, when a command fails.
constexpr const char* all_drawn = "misfit: all drawn";

bool complete(const std::string& drawing, const std::string& words) {
  return words.find(all_drawn) != std::string::npos &&
         drawing.find("</svg>", drawing.size() < 64 ? 0 : drawing.size() - 64) != std::string::npos;
}

/// Printed before script k is run.
std::string begin_of(std::size_t k) { return fmt::format("misfit: script {}\n", k); }

/// What gnuplot said of script k, without our own lines.
std::string words_on(std::size_t k, const std::string& words) {
  const std::size_t begin = words.find(begin_of(k));
  if (begin == std::string::npos) return "";
  const std::size_t from = begin + begin_of(k).size();
  return words.substr(from, words.find(begin_of(k + 1), from) - from);
}

std::string shown(std::string words) {
  words = replace_all(words, all_drawn, "");
  const std::size_t end = words.find_last_not_of(" \n\r\t");
  return end == std::string::npos ? "it says nothing" : words.substr(0, end + 1);
}

/// Without the empty group that a drawing begins with: its colour is the last one of the drawing before.
std::string without_first_group(std::string svg) {
  constexpr std::string_view before = "</defs>\n", empty = ">\n</g>\n";
  const std::size_t definitions = svg.find(before), at = definitions == std::string::npos ? definitions : definitions + before.size();
  const std::size_t end = at == std::string::npos ? at : svg.find('>', at);
  if (end != std::string::npos && std::string_view(svg).substr(end).starts_with(empty)) svg.erase(at, end + empty.size() - at);
  return svg;
}

/// gnuplot calls every drawing "Gnuplot", and what has no legend by a number, which viewers show at the mouse.
std::string with_words(const std::string& svg, const DrawingWords& words) {
  constexpr std::string_view title = "<title>Gnuplot</title>", end_of_head = "</desc>", of_part = "<title>gnuplot_plot_", end = "</title>";
  const std::size_t at = svg.find(title), body = at == std::string::npos ? at : svg.find(end_of_head, at);
  if (body == std::string::npos) return svg;
  std::string out = svg.substr(0, at) + "<title>" + escape_html(unbroken(words.title)) + "</title>\n<desc>" +
                    escape_html(unbroken(words.description)) + "</desc>";
  std::size_t done = body + end_of_head.size();
  for (std::size_t part = svg.find(of_part, done); part != std::string::npos; part = svg.find(of_part, done)) {
    out += svg.substr(done, part - done);
    done = svg.find(end, part) + end.size();
  }
  return out + svg.substr(done);
}

/// Neither ~/.gnuplot nor ./.gnuplot (-d), nor GNUTERM, GNUPLOT_LIB, locale and the like of the user.
constexpr const char* environment = "/usr/bin/env -i PATH=/usr/bin:/bin HOME=/nonexistent LC_ALL=C.UTF-8";

/// One gnuplot for all: its start takes longer than most drawings. Each script finds it as after its start.
std::vector<std::string> run_once(const fs::path& program, const fs::path& dir, const std::vector<DrawingOrder>& orders) {
  const MemoryFile said("words of gnuplot");
  std::deque<MemoryFile> drawings;
  {
    const IgnoreBrokenPipe guard;
    std::string commands;
    for (std::size_t k = 0; k < orders.size(); ++k) {
      commands += fmt::format("reset session\nunset minussign\nset encoding default\nprint '{}'\nout = '{}'\nload '{}.gp'\n",
                              shown(begin_of(k)), drawings.emplace_back("drawing").path(), orders[k].name);
      commands += fmt::format("unset multiplot\nunset output\nif (exists('drawn')) print '{}'\n", all_drawn);
    }
    Gnuplot gnuplot(fmt::format("cd -- {} && {} {} -d >{} 2>&1 || true", shell_quoted(fs::absolute(dir).string()), environment,
                                shell_quoted(fs::absolute(program).string()), said.path()));
    gnuplot << commands;
  }
  const std::string words = said.text();
  std::vector<std::string> out;
  for (std::size_t k = 0; k < orders.size(); ++k) {
    const std::string svg = without_first_group(drawings[k].text()), of_it = words_on(k, words);
    if (!complete(svg, of_it)) throw RunError("gnuplot failed on " + (dir / (orders[k].name + ".gp")).string() + ": " + shown(of_it));
    out.push_back(with_words(svg, orders[k].words));
    write_atomically(dir / (orders[k].name + ".svg"), out.back());
  }
  return out;
}

}  // namespace

std::vector<std::string> run_gnuplot(const fs::path& dir, const std::vector<DrawingOrder>& orders) {
  const std::optional<fs::path> program = find_program("gnuplot");
  if (!program)
    throw RunError("gnuplot is not installed (not on the PATH): the figures cannot be drawn; their .csv and .gp files are in " +
                   dir.string());
  std::vector<std::string> out;
  constexpr std::size_t most = 100;  // files in memory at once
  for (std::size_t first = 0; first < orders.size(); first += most) {
    const std::vector<DrawingOrder> some(orders.begin() + std::ssize(out), orders.begin() + std::min(first + most, orders.size()));
    for (std::string& svg : run_once(*program, dir, some)) out.push_back(std::move(svg));
  }
  return out;
}

}  // namespace misfit::report
