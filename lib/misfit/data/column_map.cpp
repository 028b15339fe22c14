#include "misfit/data/column_map.h"

#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/column_header.h"
#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/table.h"
#include "misfit/core/units.h"

namespace misfit {

std::string ColumnMap::header(const std::string& name) const {
  const auto it = std::find_if(header_of.begin(), header_of.end(), [&](const auto& entry) { return entry.first == name; });
  return it == header_of.end() ? name : it->second;
}

namespace {

/// Called as the signal but for a unit behind its name (ram_mm): a study says whether that is what it means. nullptr: none, or several.
const Column* with_unit_in_name(const Table& table, const std::string& name) {
  const auto called = [&](const Column& column) { return read_header(column.name).name == name; };
  const auto first = std::find_if(table.columns.begin(), table.columns.end(), called);
  if (first == table.columns.end() || std::any_of(first + 1, table.columns.end(), called)) return nullptr;
  return &*first;
}

}  // namespace

std::vector<double> ColumnMap::values(const Table& table, const std::string& name, const std::string& unit,
                                      std::vector<std::string>& notes) const {
  if (const Column* meant = table.find(header(name)) == nullptr ? with_unit_in_name(table, name) : nullptr; meant != nullptr) {
    throw InputError({table.source, 0, 0}, fmt::format("no column '{}'; if '{}' is meant: columns = {{ {} = \"{}\" }} in [[experiment]]",
                                                       shown(header(name)), shown(meant->name), name, shown(meant->name)));
  }
  const Column& column = table.at(header(name));
  const std::string column_unit = read_header(column.name).unit;
  const bool own_name = header(name) == name, own_unit = !column.unit.empty() || own_name;
  const bool others_have_units = std::any_of(table.columns.begin(), table.columns.end(), [](const Column& c) { return !c.unit.empty(); });
  if (own_name && column.unit.empty() && column_unit.empty() && others_have_units && !unit_symbols(unit).empty())
    notes.push_back(fmt::format("column '{}' has no unit, though others have: its values are taken as {}", shown(name), plain_si(unit)));
  if (own_unit || column_unit == unit) return table.values(header(name), unit);
  if (column_unit.empty() || !parse_unit(column_unit).same_dimension(parse_unit(unit))) {
    if (!unit_symbols(unit).empty())
      notes.push_back(fmt::format("column '{}' has no unit for {}: its values are taken as {}", shown(column.name), name, plain_si(unit)));
    return column.values;
  }
  std::vector<double> out = column.values;
  convert(out, column_unit, unit);
  notes.push_back(fmt::format("column '{}' is read in {}, as its name says", shown(column.name), column_unit));
  return out;
}

}  // namespace misfit
