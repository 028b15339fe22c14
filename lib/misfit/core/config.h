#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "misfit/core/error.h"

namespace misfit::config {

/// A number from a study: SI, `{value, sigma}` where the uncertainty is known.
struct Number {
  double value = 0.0;
  std::optional<double> sigma;
  std::string unit;  ///< unit asked for by the reader, or as written
  Source where;
};

/// A strict view of one TOML table. Every key that is read is noted; `finish()` throws for the keys that were not, naming file, line, the
/// key, the nearest key that was asked for and all of them. Reading a key with the wrong type is an InputError with the place and what is
/// allowed. Copies share their notes (they are views).
class Section {
 public:
  /// Parses a file. InputError with file, line and column for TOML syntax errors.
  [[nodiscard]] static Section load(const std::filesystem::path& path);
  /// Parses text; `name` stands for the file in messages.
  [[nodiscard]] static Section parse(std::string_view text, const std::string& name);

  [[nodiscard]] bool has(std::string_view key) const;      ///< does not count as reading it
  [[nodiscard]] std::vector<std::string> keys() const;     ///< in file order (by line)
  [[nodiscard]] Source where(std::string_view key) const;  ///< place of the key (of the table itself if absent)
  [[nodiscard]] Source where() const;
  [[nodiscard]] Source where_text(std::string_view key) const;  ///< of the first character of a string value (inside its quotes)
  [[nodiscard]] std::string path() const;                       ///< "geometry", "effects.bearing": for messages
  [[nodiscard]] std::filesystem::path file() const;

  /// A number in SI. Accepts 0.5, "24 in" (dimension checked against `unit`, converted to it) and, where `sigma_allowed`,
  /// { value = …, sigma = … } with either form inside. A bare number is in `unit` itself (SI); +-inf and nan are refused.
  [[nodiscard]] std::optional<Number> number(std::string_view key, std::string_view unit, bool sigma_allowed = false) const;
  [[nodiscard]] std::optional<bool> flag(std::string_view key) const;
  [[nodiscard]] std::optional<long> integer(std::string_view key, long least, long most) const;
  [[nodiscard]] std::optional<std::string> text(std::string_view key) const;
  /// One of `allowed`, else InputError with the nearest.
  [[nodiscard]] std::optional<std::string> choice(std::string_view key, const std::vector<std::string>& allowed) const;
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::string_view key, std::string_view unit) const;
  /// Numbers whose unit is known later: 0.5 as it is, with an empty unit; "24 in" in SI, with the unit as written.
  [[nodiscard]] std::optional<std::vector<Number>> quantities(std::string_view key) const;
  [[nodiscard]] std::optional<std::vector<std::string>> texts(std::string_view key) const;
  [[nodiscard]] std::optional<Section> table(std::string_view key) const;
  [[nodiscard]] std::vector<Section> tables(std::string_view key) const;  ///< array of tables; a single table counts as one
  /// Is the value of `key` a string / a number / a table / an array? (does not count as reading)
  [[nodiscard]] bool is_text(std::string_view key) const;
  [[nodiscard]] bool is_number(std::string_view key) const;
  [[nodiscard]] bool is_table(std::string_view key) const;
  [[nodiscard]] bool is_array(std::string_view key) const;
  [[nodiscard]] bool is_flag(std::string_view key) const;

  void finish() const;                                       ///< this table only; sub-tables finish themselves
  void finish(const std::vector<std::string>& valid) const;  ///< with these as the names in the message
  [[noreturn]] void fail(std::string_view key, const std::string& message) const;
  [[noreturn]] void fail_unknown(const std::string& key, const std::vector<std::string>& valid) const;
  /// The same with the value as the file has it: "section.key = VALUE: expected".
  [[noreturn]] void fail_value(std::string_view key, const std::string& expected) const;

 private:
  struct State;
  explicit Section(std::shared_ptr<State> state) : state_(std::move(state)) {}
  std::shared_ptr<State> state_;
};

/// What a TOML text says, as one line: keys in the order of the file, without comments and spaces, without the tables and keys in `without`
/// ("uncertainty", "study.name"). Two texts with the same content compute the same. `text` is valid TOML.
[[nodiscard]] std::string content_of(const std::string& text, const std::vector<std::string>& without = {});

}  // namespace misfit::config
