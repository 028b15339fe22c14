#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace misfit {

/// One column: header `name[unit]`. `unit` is empty when the header names none. Missing values are NaN in memory, empty
/// fields on disk.
struct Column {
  std::string name;
  std::string unit;
  std::vector<double> values;

  [[nodiscard]] std::string header() const;  ///< "name[unit]", or "name" without unit
};

/// Columns of equal length, in the order of the file.
struct Table {
  std::string source;     ///< file it came from, for messages; may be empty
  std::vector<int> line;  ///< line of the file each row stands on (empty for tables made in memory)
  std::vector<Column> columns;

  [[nodiscard]] std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
  /// The column called `name` (or whose full header is `name`); nullptr if there is none.
  [[nodiscard]] const Column* find(std::string_view name) const;
  /// The same, or InputError naming file, the column, the nearest header and all headers.
  [[nodiscard]] const Column& at(std::string_view name) const;
  /// Values of `name` in `unit`; a column without unit is taken to be in `unit` already. InputError if dimensions differ.
  [[nodiscard]] std::vector<double> values(std::string_view name, std::string_view unit) const;
  void add(std::string name, std::string unit, std::vector<double> values);
};

/// Reads comma-separated numbers with one header line. '#' starts a comment line; blank lines are passed over; an empty field, "nan" and
/// "NaN" are missing. Quoted fields, a UTF-8 byte-order mark, CRLF and spaces around fields are accepted.
/// InputError: file missing or unreadable, no header, no rows, a row with another number of fields, a field that is not a number (file,
/// line, column name, the text), a column named twice (in two units as well), more than 20,000 columns. Text columns are accepted when
/// listed in `ignore_text_of` (values NaN).
[[nodiscard]] Table read_csv(const std::filesystem::path& path, const std::vector<std::string>& ignore_text_of = {});

inline constexpr int all_digits = 0;

/// Writes atomically (core/files.h). `digits` significant digits; all_digits: the shortest form that reads back as the same number.
void write_csv(const std::filesystem::path& path, const Table& table, int digits = all_digits);

}  // namespace misfit
