#include "misfit/core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace misfit {
namespace {

/// Code points of a UTF-8 text: the bytes that do not continue another.
std::size_t code_points(const std::string& text) {
  return std::count_if(text.begin(), text.end(), [](unsigned char c) { return (c & 0xC0U) != 0x80U; });
}

/// Decimal exponent of the first digit of |x| > 0 once it is rounded to `digits` digits: 0.0996 with two digits is 0.10, so -1.
int rounded_exponent(double x, int digits) {
  const std::string text = fmt::format("{:.{}e}", std::abs(x), digits - 1);
  return std::atoi(text.c_str() + text.find('e') + 1);
}

/// Fixed notation with `decimals` places; a negative number of places rounds to tens, hundreds, …
std::string fixed(double x, int decimals) {
  double rounded = x;
  if (decimals < 0) {
    const double step = std::pow(10.0, -decimals);
    rounded = std::round(x / step) * step;
  }
  std::string text = fmt::format("{:.{}f}", rounded, std::max(decimals, 0));
  if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

struct ColumnForm {
  std::size_t width = 0;
  bool right = false;
};

void append_row(std::string& out, const std::vector<std::string>& cells, const std::vector<ColumnForm>& columns,
                const std::string& indent) {
  std::string line = indent;
  for (std::size_t j = 0; j < cells.size(); ++j) {
    const std::string padding(columns[j].width - code_points(cells[j]), ' ');
    line += (j > 0 ? "  " : "") + (columns[j].right ? padding + cells[j] : cells[j] + padding);
  }
  line.erase(line.find_last_not_of(' ') + 1);
  out += line + "\n";
}

}  // namespace

std::string format_value(double value, double sigma) {
  if (std::isnan(value)) return "not available";
  if (!std::isfinite(sigma) || sigma <= 0.0 || !std::isfinite(value)) return fmt::format("{:.5g}", value);
  const double size = std::max(std::abs(value), sigma);
  const int exponent = rounded_exponent(size, 2);
  const int decimals = 1 - rounded_exponent(sigma, 2);
  if (exponent >= -4 && exponent < 6) return fixed(value, decimals) + " ± " + fixed(sigma, decimals);
  const double scale = std::pow(10.0, exponent);
  return fmt::format("({} ± {})e{}", fixed(value / scale, decimals + exponent), fixed(sigma / scale, decimals + exponent), exponent);
}

std::string format_to_step(double value, double step) {
  constexpr int usual = 5, all = 15;
  const double rounded = std::round(value / step) * step + 0.0;  // no "-0"
  const int digits = rounded == 0.0 ? usual : static_cast<int>(std::floor(std::log10(std::abs(rounded) / step) + 1e-9)) + 1;
  return fmt::format("{:.{}g}", rounded, std::clamp(digits, usual, all));
}

std::string format_interval(double low, double high, double sigma) {
  const auto end = [&](double value) {
    const std::string whole = format_value(value, sigma);
    const std::size_t open = whole.front() == '(' ? 1 : 0, stop = whole.find(" ±");
    return open > 0 || stop == std::string::npos ? format_value(value) : whole.substr(0, stop);
  };
  return end(low) + " to " + end(high);
}

std::string align_columns(const std::vector<std::vector<std::string>>& rows, const std::string& indent, const std::vector<bool>& right) {
  std::vector<ColumnForm> columns;
  for (const auto& row : rows) {
    if (row.size() > columns.size()) columns.resize(row.size());
    for (std::size_t j = 0; j < row.size(); ++j) columns[j].width = std::max(columns[j].width, code_points(row[j]));
  }
  for (std::size_t j = 0; j < std::min(right.size(), columns.size()); ++j) columns[j].right = right[j];
  std::string out;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    append_row(out, rows[i], columns, indent);
    if (i > 0) continue;
    std::vector<std::string> rule;
    for (std::size_t j = 0; j < rows[0].size(); ++j) rule.emplace_back(columns[j].width, '-');
    append_row(out, rule, columns, indent);
  }
  return out;
}

std::string wrap_text(const std::string& text, std::size_t width, const std::string& indent) {
  std::string out, line, word;
  const auto end_line = [&] {
    out += line.empty() ? "\n" : indent + line + "\n";
    line.clear();
  };
  const auto end_word = [&] {
    if (word.empty()) return;
    const std::size_t needed = code_points(indent) + code_points(line) + 1 + code_points(word);
    if (!line.empty() && needed > width) end_line();
    line += (line.empty() ? "" : " ") + word;
    word.clear();
  };
  for (const char c : text) {
    if (c != ' ' && c != '\n') {
      word += c;
      continue;
    }
    end_word();
    if (c == '\n') end_line();
  }
  end_word();
  return line.empty() ? out : out + indent + line;
}

std::string format_probability(double p) {
  if (std::isnan(p)) return "not available";
  constexpr double smallest = 1e-300;
  return p < smallest ? "< 1e-300" : fmt::format("{:.2g}", p);
}

std::string p_equals(double p) {
  const std::string text = format_probability(p);
  return text.starts_with('<') ? "p " + text : "p = " + text;
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  }
  return out;
}

std::string counted(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

std::string join_words(const std::vector<std::string>& words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) out += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return out;
}

}  // namespace misfit
