#include "misfit/recording/time_column.h"

#include "misfit/core/column_header.h"
#include "misfit/core/units.h"
#include "misfit/recording/column_facts.h"

namespace misfit {

double increasing_share(const std::vector<double>& values, Repeats repeats) {
  const std::vector<double> t = finite(values);
  std::size_t count = 0, steps = 0;
  for (std::size_t i = 1; i < t.size(); ++i) {
    count += t[i] > t[i - 1] ? 1U : 0U;
    steps += repeats == Repeats::count || t[i] != t[i - 1] ? 1U : 0U;
  }
  return steps == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(steps);
}

namespace {

/// How surely a column is time, 0 the surest; nullopt: it is none.
std::optional<int> rank_of_time(const ColumnSurvey& column, const std::vector<double>& values) {
  const bool of_time = parse_unit(column.unit).same_dimension(parse_unit("s"));
  const bool called = is_called_time(column.name) && (of_time || column.unit == "-");
  if (column.use != ColumnUse::unused || !(of_time || called)) return std::nullopt;
  const double rows = increasing_share(values), steps = increasing_share(values, Repeats::do_not_count);
  if (called && (of_time || !may_be_temperature(column.name)) && steps > least_increasing_share) return 0;
  if (of_time && rows == 1.0) return 1;
  if (called && rows == 1.0) return 2;
  if (of_time && rows > least_increasing_share) return 3;
  if (called && steps > least_increasing_share) return 4;
  return std::nullopt;
}

}  // namespace

std::optional<std::size_t> surest_time(const std::vector<ColumnSurvey>& columns, const LooseTable& table) {
  std::optional<int> surest;
  std::optional<std::size_t> time;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::optional<int> rank = rank_of_time(columns[i], table.columns[i].values);
    if (!rank || (surest && *rank >= *surest)) continue;
    surest = rank;
    time = i;
  }
  return time;
}

std::string counting_column(const std::vector<ColumnSurvey>& columns, const LooseTable& table) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::vector<double>& values = table.columns[i].values;
    if (columns[i].use == ColumnUse::unused && increasing_share(values) == 1.0 && is_integer(finite(values)))
      return " ('" + columns[i].header + "' counts rows, but over which interval?)";
  }
  return "";
}

}  // namespace misfit
