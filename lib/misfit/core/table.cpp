#include "misfit/core/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "misfit/core/error.h"
#include "misfit/core/new_file.h"
#include "misfit/core/shown.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

void append_number(std::string& out, double value, int digits) {
  if (!std::isfinite(value)) return;  // missing: an empty field
  char buffer[64];
  const auto result = digits == all_digits ? std::to_chars(buffer, buffer + sizeof buffer, value)
                                           : std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits);
  out.append(buffer, result.ptr);
}

std::string quoted(const std::string& field) {
  if (field.find_first_of(",\"#") == std::string::npos) return field;
  std::string out = "\"";
  for (const char c : field) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string Column::header() const { return unit.empty() ? name : name + "[" + unit + "]"; }

const Column* Table::find(std::string_view name) const {
  const auto it = std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name || c.header() == name; });
  return it == columns.end() ? nullptr : &*it;
}

const Column& Table::at(std::string_view name) const {
  if (const Column* column = find(name)) return *column;
  std::vector<std::string> names, headers;
  for (const Column& column : columns) {
    names.push_back(column.name);
    headers.push_back(column.header());
  }
  const Column* nearest = find(nearest_name(name, names));  // by bare names: a unit would count as a difference
  const std::string end = nearest ? fmt::format(" — did you mean '{}'? Valid: ", shown(nearest->header())) : " — valid: ";
  throw InputError({source, 0, 0}, fmt::format("no column '{}'{}{}", shown(name), end, some_names(name, headers)));
}

std::vector<double> Table::values(std::string_view name, std::string_view unit) const {
  const Column& column = at(name);
  if (column.unit.empty() || column.unit == unit) return column.values;
  std::vector<double> out = column.values;
  try {
    convert(out, column.unit, unit);
  } catch (const InputError& error) {
    throw InputError({source, 0, 0}, "column '" + shown(column.header()) + "': " + error.what());
  }
  return out;
}

void Table::add(std::string name, std::string unit, std::vector<double> values) {
  columns.push_back({std::move(name), std::move(unit), std::move(values)});
}

void write_csv(const std::filesystem::path& path, const Table& table, int digits) {
  std::string out;
  for (std::size_t j = 0; j < table.columns.size(); ++j) {
    if (table.columns[j].values.size() != table.rows())
      throw std::invalid_argument("write_csv: columns of unequal length: " + path.string());
    if (j > 0) out += ',';
    out += quoted(table.columns[j].header());
  }
  out += '\n';
  NewFile file(path);
  const bool single = table.columns.size() == 1;
  constexpr std::size_t piece = 1 << 20;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const std::size_t begin = out.size();
    for (std::size_t j = 0; j < table.columns.size(); ++j) {
      if (j > 0) out += ',';
      append_number(out, table.columns[j].values[i], digits);
    }
    if (single && out.size() == begin) out += "\"\"";  // an empty line would be passed over when read
    out += '\n';
    if (out.size() < piece) continue;
    file.add(out);
    out.clear();
  }
  file.add(out);
  file.publish();
}

}  // namespace misfit
