#include "misfit/core/loose_csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_set>

#include "misfit/core/error.h"
#include "misfit/core/iso_date.h"
#include "misfit/core/mapped_file.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"

namespace misfit {
namespace {

constexpr std::string_view blanks = " \t\r";

std::string_view unquoted(std::string_view text) {
  const auto from = text.find_first_not_of(blanks);
  if (from == std::string_view::npos) return {};
  text = text.substr(from, text.find_last_not_of(blanks) - from + 1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

/// Cells of a line; a ' ' separates by any run of blanks. Separators inside quotation marks belong to the cell.
std::vector<std::string_view> cells_of(std::string_view line, char delimiter) {
  std::vector<std::string_view> cells;
  if (delimiter == ' ') {
    for (auto from = line.find_first_not_of(blanks); from != std::string_view::npos;) {
      const auto to = std::min(line.find_first_of(blanks, from), line.size());
      cells.push_back(unquoted(line.substr(from, to - from)));
      from = line.find_first_not_of(blanks, to);
    }
    return cells;
  }
  std::size_t from = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (line[i] != delimiter || quoted)) continue;
    cells.push_back(unquoted(line.substr(from, i - from)));
    from = i + 1;
  }
  return cells;
}

bool is_missing(std::string_view cell) {
  constexpr std::array<std::string_view, 7> words = {"", "nan", "-nan", "na", "n/a", "null", "none"};
  return std::find(words.begin(), words.end(), lower_case(cell)) != words.end();
}

/// nullopt if the cell is neither a finite number nor a word for a missing one.
std::optional<double> number_of(std::string_view cell, bool decimal_comma) {
  if (is_missing(cell)) return std::numeric_limits<double>::quiet_NaN();
  std::string text(cell.front() == '+' ? cell.substr(1) : cell);
  if (decimal_comma) std::replace(text.begin(), text.end(), ',', '.');
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

struct Line {
  std::string_view text;
  int number = 0;
};

class LooseReader {
 public:
  LooseReader(const std::filesystem::path& path, const std::vector<std::string>& names) : content_(path), given_(names) {
    table_.source = path.string();
  }

  LooseTable read() {
    split_lines();
    if (is_no_text()) fail(0, "this is no text: a CSV of UTF-8 is expected (or MAT, HDF5, NPY, NPZ, ULog, DataFlash .bin)");
    if (lines_.empty()) fail(0, "the file is empty: columns of numbers under a line of names are expected, as t[s],u[V],y[V]");
    find_delimiter();
    read_header();
    if (table_.columns.size() < 2)
      fail(lines_.front().number,
           "one column alone ('" + shown(table_.columns.front().header) + "') is no recording: a time and what was measured are needed");
    if (first_row_ >= lines_.size()) fail(0, "no rows below the header");
    for (LooseColumn& column : table_.columns) column.values.reserve(lines_.size() - first_row_);
    table_.line.reserve(lines_.size() - first_row_);
    for (std::size_t i = first_row_; i < lines_.size(); ++i) read_row(lines_[i]);
    for (std::size_t j = 0; j < table_.columns.size(); ++j) read_dates(j);
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(int line, const std::string& message) const { throw InputError({table_.source, line, 0}, message); }

  [[nodiscard]] bool is_no_text() const {
    constexpr std::size_t looked_at = 4096;
    return content_.text().substr(0, looked_at).find('\0') != std::string_view::npos;
  }

  void split_lines() {
    std::string_view rest = content_.text();
    if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
    for (int number = 1; !rest.empty(); ++number) {
      const auto end = std::min(rest.find('\n'), rest.size());
      std::string_view line = rest.substr(0, end);
      rest.remove_prefix(std::min(end + 1, rest.size()));
      while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
      if (line.find_first_not_of(blanks) == std::string_view::npos) continue;
      if (line.front() == '#' || line.front() == '%') {
        ++table_.comments;
        if (lines_.empty()) last_comment_ = line.substr(std::min(line.find_first_not_of("#% "), line.size()));
        continue;
      }
      lines_.push_back({line, number});
    }
  }

  /// The separator that splits the first rows and the last into the most cells, equally many in each; a comma may also be a decimal comma.
  void find_delimiter() {
    const std::size_t looked_at = std::min<std::size_t>(lines_.size(), 20);
    std::vector<std::string_view> rows{lines_.back().text};
    for (std::size_t i = 1; i < looked_at; ++i) rows.push_back(lines_[i].text);
    std::size_t most = 1;
    for (const char candidate : {';', '\t', ',', ' '}) {
      const std::size_t cells = cells_of(rows.front(), candidate).size();
      const bool equal = std::all_of(rows.begin(), rows.end(), [&](std::string_view r) { return cells_of(r, candidate).size() == cells; });
      const bool only_blank = candidate == ' ' && most > 1;  // blanks after commas are no separators
      if (!equal || cells <= most || only_blank || (candidate == ',' && most > 1)) continue;
      most = cells;
      table_.delimiter = candidate;
    }
    if (table_.delimiter == ',' && only_blanks_separate(rows)) table_.delimiter = ' ';
    table_.decimal_comma = table_.delimiter != ',' && has_decimal_commas();
  }

  /// "0,1 2,5": numbers with decimal commas, which commas would split into what is none ("1 2").
  [[nodiscard]] static bool only_blanks_separate(const std::vector<std::string_view>& rows) {
    const std::size_t columns = cells_of(rows.front(), ' ').size();
    const auto numbers = [&](char delimiter) {
      return std::all_of(rows.begin(), rows.end(), [&](std::string_view row) {
        const auto cells = cells_of(row, delimiter);
        const bool all =
            std::all_of(cells.begin(), cells.end(), [&](std::string_view c) { return number_of(c, delimiter == ' ').has_value(); });
        return all && (delimiter != ' ' || cells.size() == columns);
      });
    };
    return columns > 1 && numbers(' ') && !numbers(',');
  }

  /// By the first row with more numbers that have a decimal comma than such that have a point. Dates are no numbers.
  [[nodiscard]] bool has_decimal_commas() const {
    for (std::size_t i = lines_.size() > 1 ? 1 : 0; i < lines_.size(); ++i) {
      if (lines_[i].text.find_first_of(",.") == std::string_view::npos) continue;
      const std::vector<std::string_view> cells = cells_of(lines_[i].text, table_.delimiter);
      const auto count = [&](char sign) {
        return std::count_if(cells.begin(), cells.end(), [&](std::string_view c) {
          return c.find(sign) != std::string_view::npos && number_of(c, sign == ',').has_value();
        });
      };
      const auto commas = count(','), points = count('.');
      if (commas != points) return commas > points;
    }
    return false;
  }

  [[nodiscard]] bool all_numbers(const std::vector<std::string_view>& cells) const {
    return std::all_of(cells.begin(), cells.end(), [&](std::string_view c) { return !c.empty() && number_of(c, table_.decimal_comma); });
  }

  [[nodiscard]] static bool begins_with_date(const std::vector<std::string_view>& cells) {
    return std::any_of(cells.begin(), cells.end(), [](std::string_view c) { return read_iso_date(c).has_value(); });
  }

  /// A column in which every cell that is not empty is a date is one of seconds.
  void read_dates(std::size_t j) {
    LooseColumn& column = table_.columns[j];
    if (column.text == 0 || !read_iso_date(column.first_text)) return;
    std::vector<double> seconds;
    std::optional<IsoDate> first;
    for (std::size_t i = first_row_; i < lines_.size(); ++i) {
      const std::string_view cell = cells_of(lines_[i].text, table_.delimiter)[j];
      const auto date = read_iso_date(cell);
      if (!date && !is_missing(cell)) return;
      if (date && !first) {
        first = date;
        column.first_date = std::string(cell);
      }
      seconds.push_back(date ? seconds_between(*first, *date) : std::numeric_limits<double>::quiet_NaN());
    }
    constexpr double days = 3.0 * 86400.0;
    column.from_midnight = std::any_of(seconds.begin(), seconds.end(), [](double t) { return t >= days; });
    if (column.from_midnight) {
      for (double& t : seconds) t += first->since_midnight + first->part;
    }
    column.values = std::move(seconds);
    column.dates = true;
    column.text = 0;
  }

  void read_header() {
    std::vector<std::string_view> names = cells_of(lines_.front().text, table_.delimiter);
    first_row_ = 1;
    const bool headless = all_numbers(names) || begins_with_date(names);
    if (!given_.empty()) {
      if (given_.size() != names.size())
        fail(lines_.front().number, std::to_string(given_.size()) + " names are given for " + std::to_string(names.size()) + " columns");
      names.assign(given_.begin(), given_.end());
      first_row_ = headless ? 0 : 1;
    } else if (headless) {
      const auto commented = cells_of(last_comment_, table_.delimiter);
      if (commented.size() != names.size() || all_numbers(commented)) {
        fail(lines_.front().number,
             "no header: the first line holds numbers; put the names of the columns above it, as t[s],u[V],y[V], or give them: --names "
             "t[s],u[V],y[V]");
      }
      names = commented;
      first_row_ = 0;
    }
    std::unordered_set<std::string> known;
    for (const std::string_view name : names) {
      LooseColumn column;
      column.header = name.empty() ? "column_" + std::to_string(table_.columns.size() + 1) : std::string(name);
      if (!known.insert(column.header).second) fail(lines_.front().number, "the header names column '" + shown(column.header) + "' twice");
      table_.columns.push_back(std::move(column));
    }
  }

  void read_row(const Line& line) {
    std::vector<std::string_view> cells = cells_of(line.text, table_.delimiter);
    if (cells.size() == table_.columns.size() + 1 && cells.back().empty()) cells.pop_back();  // a separator at the end of the line
    if (cells.size() != table_.columns.size()) {
      fail(line.number, std::to_string(cells.size()) + " cells where the header has " + std::to_string(table_.columns.size()) +
                            (table_.delimiter == ',' && cells.size() > table_.columns.size()
                                 ? ": decimal commas are read between semicolons or tabs, not between commas"
                                 : ""));
    }
    for (std::size_t j = 0; j < cells.size(); ++j) {
      LooseColumn& column = table_.columns[j];
      const auto value = number_of(cells[j], table_.decimal_comma);
      if (!value && column.text++ == 0) {
        column.text_line = line.number;
        column.first_text = std::string(cells[j]);
      }
      column.values.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    table_.line.push_back(line.number);
  }

  FileText content_;
  const std::vector<std::string>& given_;
  std::string_view last_comment_;
  std::vector<Line> lines_;
  std::size_t first_row_ = 1;
  LooseTable table_;
};

}  // namespace

LooseTable read_loose_csv(const std::filesystem::path& path, const std::vector<std::string>& names) {
  return LooseReader(path, names).read();
}

}  // namespace misfit
