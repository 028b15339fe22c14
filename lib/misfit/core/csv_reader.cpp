// read_csv of table.h.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

#include "misfit/core/error.h"
#include "misfit/core/iso_date.h"
#include "misfit/core/mapped_file.h"
#include "misfit/core/shown.h"
#include "misfit/core/table.h"

namespace misfit {
namespace {

std::string_view trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) text.remove_suffix(1);
  return text;
}

constexpr std::size_t max_columns = 20'000;

bool is_nan_word(std::string_view text) {
  if (text.starts_with('-')) text.remove_prefix(1);
  return text.size() == 3 && (text[0] | 32) == 'n' && (text[1] | 32) == 'a' && (text[2] | 32) == 'n';
}

/// NaN for a missing value; nullopt if the field is no finite number.
std::optional<double> parse_number(std::string_view field) {
  if (field.empty() || is_nan_word(field)) return std::numeric_limits<double>::quiet_NaN();
  if (field.starts_with('+') && field.size() > 1 && field[1] != '-') field.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error == std::errc::result_out_of_range && end == field.data() + field.size()) {
    // Out of range is also said of numbers too small to hold: those are zero, too large ones are refused.
    return field.find("e-") != std::string_view::npos || field.find("E-") != std::string_view::npos ? std::optional(0.0) : std::nullopt;
  }
  if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// "alpha_T[deg]" → name and unit.
Column parse_header(std::string_view text) {
  const std::size_t open = text.rfind('[');
  if (open == std::string_view::npos || !text.ends_with(']')) return {std::string(text), "", {}};
  return {std::string(trim(text.substr(0, open))), std::string(trim(text.substr(open + 1, text.size() - open - 2))), {}};
}

class CsvReader {
 public:
  CsvReader(const std::filesystem::path& path, const std::vector<std::string>& ignore_text_of)
      : content_(path), ignore_text_of_(ignore_text_of) {
    table_.source = path.string();
  }

  Table read() {
    std::string_view rest = content_.text();
    if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
    for (int number = 1; !rest.empty(); ++number) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      const std::string_view line = trim(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
      if (line.empty() || line.front() == '#') continue;
      split(line, number);
      if (table_.columns.empty()) {
        read_header(number);
      } else {
        read_row(number);
      }
    }
    if (table_.columns.empty())
      throw InputError({table_.source, 0, 0}, "no header line: the first line must name the columns, as in t[s],y[m]");
    if (table_.rows() == 0) throw InputError({table_.source, 0, 0}, "no rows below the header");
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(int line, const std::string& message) const { throw InputError({table_.source, line, 0}, message); }

  void split(std::string_view line, int number) {
    fields_.clear();
    if (line.find('"') == std::string_view::npos) {
      for (;;) {
        const std::size_t comma = line.find(',');
        fields_.emplace_back(trim(line.substr(0, comma)));
        if (comma == std::string_view::npos) return;
        line.remove_prefix(comma + 1);
      }
    }
    split_quoted(line, number);
  }

  /// "" inside quotes stands for one quotation mark; a comma inside quotes belongs to the field. A field ends on its line.
  void split_quoted(std::string_view line, int number) {
    unquoted_.clear();
    std::string field;
    bool inside = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '"' && inside && i + 1 < line.size() && line[i + 1] == '"') {
        field += line[++i];
      } else if (line[i] == '"') {
        inside = !inside;
      } else if (line[i] == ',' && !inside) {
        unquoted_.emplace_back(trim(field));
        field.clear();
      } else {
        field += line[i];
      }
    }
    if (inside) fail(number, "a quotation mark is not closed on its line");
    unquoted_.emplace_back(trim(field));
    fields_.assign(unquoted_.begin(), unquoted_.end());
  }

  void read_header(int number) {
    if (fields_.size() == 1 && fields_[0].find_first_of(";\t") != std::string_view::npos)
      fail(number, "fields must be separated by commas");
    const bool all_numbers = std::all_of(fields_.begin(), fields_.end(), [](std::string_view f) { return !f.empty() && parse_number(f); });
    if (all_numbers) fail(number, "no header line: the first line holds numbers, it must name the columns, as in t[s],y[m]");
    if (fields_.size() > max_columns)
      fail(number, std::to_string(fields_.size()) + " columns; at most " + std::to_string(max_columns) + " are possible");
    std::unordered_map<std::string, std::string> headers;  // by bare name
    for (const std::string_view field : fields_) {
      if (field.empty()) fail(number, "column " + std::to_string(table_.columns.size() + 1) + " has no name in the header");
      Column column = parse_header(field);
      const auto [earlier, is_new] = headers.emplace(column.name, column.header());
      if (!is_new) refuse_twice(number, column.name, earlier->second, column.header());
      table_.columns.push_back(std::move(column));
    }
    for (const Column& column : table_.columns) {
      text_allowed_.push_back(std::any_of(ignore_text_of_.begin(), ignore_text_of_.end(),
                                          [&](const std::string& name) { return column.name == name || column.header() == name; }));
    }
  }

  /// Columns that differ only in their unit are refused: a name would be ambiguous.
  [[noreturn]] void refuse_twice(int line, const std::string& name, const std::string& earlier, const std::string& header) const {
    const std::string both = "'" + shown(earlier) + "' and '" + shown(header) + "'";
    fail(line, "the header names column " + (earlier == header ? "'" + shown(header) + "' twice" : "'" + shown(name) + "' twice: " + both));
  }

  void read_row(int number) {
    if (fields_.size() != table_.columns.size()) {
      fail(number, std::to_string(fields_.size()) + " fields where the header has " + std::to_string(table_.columns.size()));
    }
    for (std::size_t j = 0; j < fields_.size(); ++j) {
      const std::optional<double> value = parse_number(fields_[j]);
      if (!value && !text_allowed_[j]) {
        fail(number, "column '" + shown(table_.columns[j].header()) + "': '" + shown(fields_[j]) + "' is not a finite number (" +
                         (read_iso_date(fields_[j]) ? "dates are read by misfit init, which writes them as seconds)"
                                                    : "leave a missing value empty)"));
      }
      table_.columns[j].values.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    table_.line.push_back(number);
  }

  FileText content_;
  const std::vector<std::string>& ignore_text_of_;
  std::vector<bool> text_allowed_;
  std::vector<std::string_view> fields_;
  std::vector<std::string> unquoted_;  // what the views of fields_ look at, where a line has quotation marks
  Table table_;
};

}  // namespace

Table read_csv(const std::filesystem::path& path, const std::vector<std::string>& ignore_text_of) {
  return CsvReader(path, ignore_text_of).read();
}

}  // namespace misfit
