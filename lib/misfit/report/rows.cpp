#include "misfit/report/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/report/symbols.h"

namespace misfit::report {
namespace {

std::string quoted(const std::string& field) {
  if (field.find_first_of(",\"\n#") == std::string::npos) return field;
  std::string result = "\"";
  for (const char c : field) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string plain_number(double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string(); }

/// Lines of a table of subjects: what, unit, then one cell per subject ("" where the subject has no such row).
std::vector<std::vector<std::string>> lines_of(const std::vector<Subject>& subjects) {
  std::vector<std::vector<std::string>> lines;
  for (std::size_t k = 0; k < subjects.size(); ++k) {
    for (const Row& row : subjects[k].rows) {
      const auto same = [&](const std::vector<std::string>& line) { return line[0] == row.what && line[1] == row.shown_unit(); };
      auto line = std::find_if(lines.begin(), lines.end(), same);
      if (line == lines.end()) {
        std::vector<std::string> fresh(subjects.size() + 2);
        fresh[0] = row.what;
        fresh[1] = row.shown_unit();
        line = lines.insert(lines.end(), std::move(fresh));
      }
      (*line)[k + 2] = row.shown_number();
    }
  }
  return lines;
}

std::string cell(const char* tag, const std::string& classes, const std::string& html) {
  return fmt::format("<{}{}>{}</{}>", tag, classes.empty() ? "" : " class=\"" + classes + "\"", html, tag);
}

}  // namespace

Row::Row(std::string what_, double value_, double sigma_, std::string unit_)
    : what(std::move(what_)), value(value_), sigma(sigma_), unit(std::move(unit_)) {
  if (unit.empty()) throw InputError("'" + what + "' has no unit: a number without unit does not enter a report ('-' for a pure number)");
  static_cast<void>(parse_unit(unit));
}

std::string Row::shown_unit() const { return display_unit(unit); }
double Row::in_shown_unit(double number) const { return convert(number, unit, shown_unit()); }
std::string Row::shown_number() const { return format_value(in_shown_unit(value), in_shown_unit(sigma)); }

std::string rows_text(const std::vector<Row>& rows) {
  std::vector<std::vector<std::string>> cells = {{"what", "value", "unit"}};
  for (const Row& row : rows) cells.push_back({row.what, row.shown_number(), row.shown_unit()});
  return align_columns(cells);
}

void write_rows_csv(const std::filesystem::path& path, const std::vector<Row>& rows) {
  std::string text = "what,value,sigma,unit\n";
  for (const Row& row : rows) {
    const std::string sigma = row.sigma > 0.0 ? plain_number(row.in_shown_unit(row.sigma)) : std::string();
    text += fmt::format("{},{},{},{}\n", quoted(row.what), plain_number(row.in_shown_unit(row.value)), sigma, quoted(row.shown_unit()));
  }
  write_atomically(path, text);
}

std::string rows_html(const std::vector<Row>& rows) {
  std::string html = "<div class=\"wide\"><table><thead><tr><th></th><th class=\"number\">value</th><th>unit</th></tr></thead><tbody>\n";
  for (const Row& row : rows) {
    std::string number = row.shown_number();
    if (row.interval) {
      const double low = row.in_shown_unit(row.interval->first), high = row.in_shown_unit(row.interval->second);
      number += " (95 %: " + format_interval(low, high, row.in_shown_unit(row.sigma)) + ")";
    }
    html += "<tr>" + cell("th", "", html_text(row.what)) + cell("td", "number", html_text(number)) +
            cell("td", "unit", html_text(row.shown_unit())) + "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string subjects_text(const std::vector<Subject>& subjects) {
  std::vector<std::vector<std::string>> cells = {{"", "unit"}};
  for (const Subject& subject : subjects) cells.front().push_back(subject.name);
  for (std::vector<std::string>& line : lines_of(subjects)) cells.push_back(std::move(line));
  return align_columns(cells);
}

std::string subjects_html(const std::vector<Subject>& subjects) {
  std::string html = "<div class=\"wide\"><table><thead><tr><th></th><th>unit</th>";
  for (const Subject& subject : subjects) html += cell("th", "number", html_text(subject.name));
  html += "</tr></thead><tbody>\n";
  for (const std::vector<std::string>& line : lines_of(subjects)) {
    html += "<tr>" + cell("th", "", html_text(line[0])) + cell("td", "unit", html_text(line[1]));
    for (std::size_t k = 2; k < line.size(); ++k) html += cell("td", "number", line[k].empty() ? "–" : html_text(line[k]));
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace misfit::report
