#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace misfit {

/// Where a piece of user input stands. `line` and `column` count from 1; 0 means "not known".
struct Source {
  std::string file;
  int line = 0;
  int column = 0;

  /// "file:line:column", leaving out what is not known; empty if there is no file.
  [[nodiscard]] std::string text() const;
};

/// The request is wrong: command line, study or a file's form. The program exits with status 2.
/// The message names the place, the value, what is allowed and, for a name, the nearest valid one.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
  InputError(const Source& where, const std::string& message);
  /// Without a file: not known.
  [[nodiscard]] const Source& where() const noexcept { return where_; }

 private:
  Source where_;
};

/// The request is well formed but the data, the model or the machine cannot do it. Exit status 1.
class RunError : public std::runtime_error {
 public:
  explicit RunError(const std::string& message) : std::runtime_error(message) {}
};

/// The valid name with the smallest edit distance (Levenshtein, case-insensitive) to `name`; empty if `valid` is empty
/// or nothing is close (distance above half the length of `name`, and neither contains the other).
[[nodiscard]] std::string nearest_name(std::string_view name, const std::vector<std::string>& valid);

/// " — did you mean 'X'? Valid: A, B, C": the tail of an error about an unknown name.
[[nodiscard]] std::string suggest(std::string_view name, const std::vector<std::string>& valid);

}  // namespace misfit
