#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "apps/print.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string shown(double value, double sigma, const std::string& unit) {
  const std::string u = display_unit(unit);
  return format_value(convert(value, unit, u), convert(sigma, unit, u)) + (u == "-" ? "" : " " + u);
}

constexpr std::size_t most_rows = 40, most_columns = 4;

/// The numbers that most studies have, the trim first.
std::vector<std::string> columns_of(const Batch& batch) {
  std::vector<std::string> names;
  for (const BatchSummary& s : batch.summary) {
    if (std::find(names.begin(), names.end(), s.name) == names.end()) names.push_back(s.name);
  }
  std::stable_partition(names.begin(), names.end(), [](const std::string& name) { return name == "trim"; });
  names.resize(std::min(names.size(), most_columns));
  return names;
}

std::string studies_table(const Batch& batch) {
  const std::vector<std::string> columns = columns_of(batch);
  Rows rows{{"study", "method", "status"}};
  rows.front().insert(rows.front().end(), columns.begin(), columns.end());
  for (std::size_t i = 0; i < std::min(most_rows, batch.rows.size()); ++i) {
    const BatchRow& row = batch.rows[i];
    rows.push_back({row.study, row.method.empty() ? "–" : row.method, row.status});
    for (const std::string& name : columns) {
      const auto found = row.values.find(name);
      rows.back().push_back(found == row.values.end() ? "–" : shown(found->second.value, found->second.sigma, found->second.unit));
    }
  }
  std::string out = align_columns(rows);
  if (batch.rows.size() > most_rows) out += fmt::format("  … and {} more rows in batch.csv\n", batch.rows.size() - most_rows);
  return out;
}

std::string summary_table(const Batch& batch) {
  if (batch.summary.empty()) return "";
  Rows rows{{"result", "method", "studies", "mean", "std. dev.", "mean sigma", "p (homogeneity)"}};
  const auto plain = [](double v, const std::string& unit) { return v > 0.0 && std::isfinite(v) ? shown(v, 0.0, unit) : std::string("–"); };
  std::vector<BatchSummary> order = batch.summary;
  std::stable_partition(order.begin(), order.end(), [](const BatchSummary& s) { return s.name == "trim"; });
  for (const BatchSummary& s : order) {
    rows.push_back({s.name, s.method, std::to_string(s.count), shown(s.mean, s.mean_sigma, s.unit),
                    plain(s.scatter > 1e-12 * std::abs(s.mean) ? s.scatter : 0.0, s.unit), plain(s.own_sigma, s.unit),
                    s.p_value ? format_probability(*s.p_value) : "–"});
  }
  return "\n" + align_columns(rows);
}

/// What the means leave out.
std::string left_out_text(const Batch& batch) {
  std::map<std::string, std::vector<std::string>> studies;
  for (const BatchRow& row : batch.rows) {
    if (row.status == "not_converged") studies[row.method].push_back(row.study);
  }
  std::string out;
  for (const auto& [method, names] : studies) {
    const std::string who = fmt::format("{} has not converged in {}: excluded from mean, std. dev. and p", method, fmt::join(names, ", "));
    out += wrap_text("! " + who, 110, "  ") + "\n";
  }
  return out;
}

/// Each study that gave nothing, with its words; the same words once.
std::string failures_text(const Batch& batch) {
  std::map<std::string, std::vector<std::string>> studies;
  for (const BatchRow& row : batch.rows) {
    if (row.method.empty()) studies[row.message].push_back(row.study);
  }
  std::string out;
  for (const auto& [why, names] : studies) {
    const std::string who = names.size() == 1 ? names.front() : fmt::format("{} and {} more", names.front(), names.size() - 1);
    out += wrap_text(fmt::format("! {}: {}", who, why), 110, "  ") + "\n";
  }
  return out;
}

}  // namespace

std::string batch_text(const Batch& batch) {
  return studies_table(batch) + summary_table(batch) + left_out_text(batch) + failures_text(batch);
}

}  // namespace misfit
