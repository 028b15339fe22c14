#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/data/curve_coefficient.h"
#include "misfit/show/results.h"
#include "misfit/show/rows.h"

namespace misfit {
namespace {

std::string in_words(FitStatus status) {
  std::string words = to_string(status);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

/// The range in which the data determine it.
std::string range_of(const CurveEstimate& curve) {
  if (!curve.informative) return "not informative: " + curve.why;
  double lowest = std::nan(""), highest = std::nan("");
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (!(curve.count[i] > 0.0)) continue;
    if (!std::isfinite(lowest)) lowest = curve.x[i];
    highest = curve.x[i];
  }
  if (!std::isfinite(lowest)) return kMissing;  // nothing was visited
  const std::string range =
      fmt::format("from {:.4g} to {:.4g}", display_value(lowest, curve.of_unit), display_value(highest, curve.of_unit));
  return with_display_unit(range, curve.of_unit) + " of " + curve.of;
}

/// "noise of w", "frequency of the coloured noise of w": of the names of fit.json, "w" and "w_coloured_frequency".
std::string noise_in_words(const std::string& name, const std::map<std::string, Estimate>& noise) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 3> parts = {
      {{"_coloured_frequency", "frequency of the coloured noise of "},
       {"_coloured_damping", "damping of the coloured noise of "},
       {"_coloured", "coloured noise of "}}};
  for (const auto& [end, words] : parts) {
    if (!name.ends_with(end)) continue;
    const std::string channel = name.substr(0, name.size() - end.size());
    if (noise.contains(channel)) return std::string(words) + channel;
  }
  return "noise of " + name;
}

Blocks blocks_of(const Fit& fit) {
  Blocks out;
  out.heading(fmt::format("{}: {} ({:.2f} s, {})", fit.method, in_words(fit.status), fit.seconds,
                          counted(static_cast<std::size_t>(fit.linearisations), "linearisation", "linearisations")));
  out.paragraph(fit.message);
  if (const auto integration = fit.facts.find("integration"); integration != fit.facts.end())
    out.paragraph("Integration: " + integration->second + ".");
  for (const auto& [name, words] : fit.facts) {
    if (name.rfind("start of ", 0) == 0) out.paragraph("S" + name.substr(1) + ": " + words + ".");
  }
  std::vector<Row> rows;
  if (fit.trim) rows.emplace_back("trim", *fit.trim);
  add_rows(rows, "RMS of ", fit.rms);
  add_rows(rows, "RMS of ", fit.validation_rms, ", held out");
  TableBlock table = rows_table("result", rows);
  for (const auto& [name, words] : fit.facts) {
    if (name.rfind("residuals of ", 0) == 0) table.rows.push_back({name, words});
  }
  const TableBlock parameters = parameter_table(fit);
  table.rows.insert(table.rows.end(), parameters.rows.begin(), parameters.rows.end());
  for (const CurveEstimate& curve : fit.curves) {
    const auto freedom = fit.facts.find(freedom_fact(curve.name));
    const std::string more = freedom == fit.facts.end() ? "" : "; " + freedom->second + " effective degrees of freedom";
    table.rows.push_back({"curve " + curve.name, range_of(curve) + more});
  }
  out.table(std::move(table));
  out.warnings(fit.warnings);
  return out;
}

}  // namespace

TableBlock parameter_table(const Fit& fit) {
  std::vector<Row> others;
  TableBlock table{columns("parameter|value")};
  for (const auto& [name, estimate] : fit.parameters) {
    if (!is_curve_coefficient(name))
      table.rows.push_back({name, Row(name, estimate).shown() + (estimate.sigma > 0.0 ? "" : " (sigma not available)")});
  }
  for (const auto& [name, estimate] : fit.noise) others.emplace_back(noise_in_words(name, fit.noise), estimate);
  add_rows(others, "random force, ", fit.force);
  const TableBlock more = rows_table("", others);
  table.rows.insert(table.rows.end(), more.rows.begin(), more.rows.end());
  return table;
}

Blocks status_blocks(const std::vector<Fit>& fits) {
  Blocks out;
  TableBlock table{columns("method|status|termination|>time [s]|>linearisations")};
  std::vector<std::string> warnings;
  for (const Fit& fit : fits) {
    table.rows.push_back(
        {fit.method, in_words(fit.status), fit.message, fmt::format("{:.2f}", fit.seconds), std::to_string(fit.linearisations)});
    for (const std::string& warning : fit.warnings) warnings.push_back(fit.method + ": " + warning);
  }
  out.table(std::move(table));
  out.warnings(warnings);
  return out;
}

Blocks blocks_of(const std::vector<Fit>& fits) {
  Blocks out;
  for (const Fit& fit : fits) out.append(blocks_of(fit));
  return out;
}

}  // namespace misfit
