#include "misfit/serve/session_script.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/shell_word.h"

namespace misfit::serve {
namespace {

namespace fs = std::filesystem;

constexpr const char* head =
    "#!/bin/sh\n# What was done in the page of `misfit open`, as commands. On the study as it was at first, and without its folder of "
    "results,\n# sh session.sh gives the same again.\nset -e\n";

/// The line that goes to the folder in which a command is typed; empty where the lines before it have gone there.
std::string way_there(const std::string& before) {
  const std::string line = "cd -- " + shell_word(fs::current_path().string()) + "\n";
  const std::size_t last = before.rfind("\ncd -- ");
  return last != std::string::npos && before.compare(last + 1, line.size(), line) == 0 ? "" : line;
}

/// A word that is no line of the text.
std::string end_mark(const std::string& text) {
  std::string mark = "END_OF_STUDY";
  while (text.find(mark) != std::string::npos) mark += "_";
  return mark;
}

}  // namespace

std::string command_of(const std::vector<std::string>& words) {
  std::string out = "misfit";
  for (const std::string& word : words) out += " " + shell_word(word);
  return out;
}

void SessionScript::record_text(const Opened& opened, const std::string& study, const std::string& text) const {
  const std::string mark = end_mark(text);
  append(opened, "cat > " + shell_word(study) + " <<'" + mark + "'\n" + text + (text.ends_with('\n') ? "" : "\n") + mark + "\n");
}

void SessionScript::record_end(const std::string& command, int status, bool stopped) const {
  const Opened opened = open();  // nobody adds a line meanwhile
  std::string lines = text();
  const std::size_t before = lines.rfind("\n" + command + "\n");
  if (before == std::string::npos) return;
  std::string instead = "# stopped: " + command;
  if (!stopped) instead = status == 1 ? command + " || [ $? -eq 1 ]" : fmt::format("# ended with status {}: {}", status, command);
  write_atomically(path_, lines.replace(before + 1, command.size(), instead));
}

std::string SessionScript::text() const {
  std::error_code none;
  return fs::symlink_status(path_, none).type() == fs::file_type::regular ? read_file(path_) : "";
}

void SessionScript::append(const Opened& opened, const std::string& lines) const {
  const std::string before = text();
  opened.append((before.empty() ? head : "") + way_there(before) + lines);
}

SessionScript::Opened::Opened(const fs::path& path) : path_(path) {
  make_writable_folder(path.parent_path());
  do {
    if (file_ >= 0) ::close(file_);
    file_ = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (file_ < 0) throw WriteError(path.string() + ": cannot be written: " + std::strerror(errno));
    ::flock(file_, LOCK_EX);
  } while (!is_there());
}

/// False: another process has put a new file in its place before this one could be locked.
bool SessionScript::Opened::is_there() const {
  struct stat own {
  }, there{};
  return ::fstat(file_, &own) == 0 && ::stat(path_.c_str(), &there) == 0 && own.st_ino == there.st_ino && own.st_dev == there.st_dev;
}

SessionScript::Opened::~Opened() { ::close(file_); }

void SessionScript::Opened::append(const std::string& lines) const {
  if (::write(file_, lines.data(), lines.size()) != static_cast<ssize_t>(lines.size()))
    throw WriteError(path_.string() + ": cannot be written: " + std::strerror(errno));
}

}  // namespace misfit::serve
