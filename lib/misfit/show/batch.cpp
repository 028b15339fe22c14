#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/text.h"
#include "misfit/show/results.h"
#include "misfit/show/rows.h"

namespace misfit {
namespace {

constexpr std::size_t max_columns = 4;

/// The trim first.
std::vector<BatchSummary> in_order(const Batch& batch) {
  std::vector<BatchSummary> order = batch.summary;
  std::stable_partition(order.begin(), order.end(), [](const BatchSummary& s) { return s.name == "trim"; });
  return order;
}

TableBlock study_table(const Batch& batch) {
  TableBlock table{columns("study|method|status"), {}, {40, "batch.csv"}};
  std::vector<std::string> names;
  for (const BatchSummary& s : in_order(batch)) {
    if (names.size() < max_columns && std::find(names.begin(), names.end(), s.name) == names.end()) names.push_back(s.name);
  }
  for (const std::string& name : names) table.columns.push_back({name});
  for (const BatchRow& row : batch.rows) {
    table.rows.push_back({row.study, row.method.empty() ? kMissing : row.method, row.status});
    for (const std::string& name : names) {
      const auto found = row.values.find(name);
      table.rows.back().push_back(found == row.values.end() ? kMissing : shown(found->second));
    }
  }
  return table;
}

TableBlock summary_table(const Batch& batch) {
  TableBlock table{columns("result|method|>studies|mean|std. dev. between studies|RMS of their sigmas|>p (homogeneity)")};
  const auto positive = [](double v, const std::string& unit) {
    return v > 0.0 && std::isfinite(v) ? shown(Estimate{v, 0.0, unit}) : std::string(kMissing);
  };
  constexpr double rounding = 1e-12;
  for (const BatchSummary& s : in_order(batch)) {
    table.rows.push_back({s.name, s.method, std::to_string(s.count), shown(Estimate{s.mean, s.mean_sigma, s.unit}),
                          positive(s.scatter > rounding * std::abs(s.mean) ? s.scatter : 0.0, s.unit), positive(s.own_sigma, s.unit),
                          s.p_value ? format_probability(*s.p_value) : kMissing});
  }
  return table;
}

using Studies = std::map<std::string, std::vector<std::string>>;  // method or message → studies

/// What the means leave out, and why studies gave nothing, the same words once.
std::vector<std::string> left_out(const Batch& batch) {
  Studies not_converged, failed;
  for (const BatchRow& row : batch.rows) {
    if (row.status == "not_converged") not_converged[row.method].push_back(row.study);
    if (row.method.empty()) failed[row.message].push_back(row.study);
  }
  std::vector<std::string> out;
  for (const auto& [method, studies] : not_converged)
    out.push_back(fmt::format("{} has not converged in {}: excluded from mean, std. dev. and p", method, fmt::join(studies, ", ")));
  for (const auto& [why, studies] : failed)
    out.push_back(studies.front() + (studies.size() > 1 ? fmt::format(" and {} more", studies.size() - 1) : "") + ": " + why);
  return out;
}

}  // namespace

Blocks blocks_of(const Batch& batch) {
  Blocks out;
  out.heading("Batch");
  out.table(study_table(batch));
  out.table(summary_table(batch));
  out.warnings(left_out(batch));
  return out;
}

}  // namespace misfit
