#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace misfit::serve {

/// "misfit add motor coulomb_friction"
[[nodiscard]] std::string command_of(const std::vector<std::string>& words);

/// session.sh of a run folder: what was done in the page, as commands that do it again. Made when the first is recorded; never written
/// through a link.
class SessionScript {
 public:
  /// `folder`: the run folder; commands are those typed in the current folder, to which a line goes where those before were typed in
  /// another.
  explicit SessionScript(const std::filesystem::path& folder) : path_(folder / "session.sh") {}

  /// The file, opened to be appended to, by one at a time, also of several servers: who has one can record.
  class Opened {
   public:
    explicit Opened(const std::filesystem::path& path);  ///< WriteError: it cannot be written
    ~Opened();
    Opened(const Opened&) = delete;
    Opened& operator=(const Opened&) = delete;
    void append(const std::string& lines) const;

   private:
    [[nodiscard]] bool is_there() const;

    std::filesystem::path path_;
    int file_ = -1;
  };
  [[nodiscard]] Opened open() const { return Opened(path_); }

  void record(const std::string& command) const { append(open(), command + "\n"); }
  /// The command, of which this is the last line, ended otherwise than well. With status 1 it may have left results (a method that
  /// declines): its line lets the others follow. Stopped or refused, it is not to be done again: its line becomes a comment.
  void record_end(const std::string& command, int status, bool stopped) const;
  /// That the study was given this text.
  void record_text(const Opened& opened, const std::string& study, const std::string& text) const;
  /// All of it; empty if nothing was recorded.
  [[nodiscard]] std::string text() const;

 private:
  void append(const Opened& opened, const std::string& lines) const;

  std::filesystem::path path_;
};

}  // namespace misfit::serve
