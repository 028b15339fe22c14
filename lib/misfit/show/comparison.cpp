#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/show/results.h"
#include "misfit/show/rows.h"

namespace misfit {
namespace {

std::vector<Row> rows_of(const MethodSummary& m) {
  std::vector<Row> rows;
  if (m.trim) rows.emplace_back("trim", *m.trim);
  add_rows(rows, "slope of ", m.slopes, " at the trim");
  add_rows(rows, "", m.at_trim, " at the trim");
  add_rows(rows, "", m.parameters);
  add_rows(rows, "RMS of ", m.rms);
  add_rows(rows, "RMS of ", m.validation_rms, ", held out");
  if (m.loglik) rows.emplace_back("log-likelihood", *m.loglik, 0.0, "-");
  if (m.validation_loglik) rows.emplace_back("log-likelihood, held out", *m.validation_loglik, 0.0, "-");
  return rows;
}

/// Three significant digits, without unit.
std::string short_number(double shown) { return std::isfinite(shown) ? fmt::format("{:.3g}", shown) : kMissing; }

/// To a hundredth of a range, without unit.
std::string to_range(double shown, double range) {
  constexpr double part = 0.01;
  return std::isfinite(shown) && range > 0.0 && std::isfinite(range) ? format_to_step(shown, part * range) : short_number(shown);
}

/// Of a quantity's levels, both ends with the digits by which they differ.
std::string range(double low, double high, const std::string& si) {
  const double from = display_level(low, si), to = display_level(high, si);
  return with_level_unit(to_range(from, to - from) + " to " + to_range(to, to - from), si);
}

/// One level in such a range.
std::string place(double at, double low, double high, const std::string& si) {
  return with_level_unit(to_range(display_level(at, si), display_level(high, si) - display_level(low, si)), si);
}

/// Quantiles of no interest by themselves only where they are outside; correlations and spectral lines as a count.
void add_group(const MotionSeries& s, const MotionGroup& g, TableBlock& table) {
  const std::string name = s.experiment + " " + s.name;
  std::string p = fmt::format("{:.3f}", g.p_value);
  if (g.name == "autocorrelation" || g.name == "spectrum") {
    const auto outside = std::count_if(g.numbers.begin(), g.numbers.end(), [](const MotionNumber& n) { return n.outside; });
    const auto known = std::count_if(g.numbers.begin(), g.numbers.end(), is_known);
    table.rows.push_back({name, g.name, fmt::format("{} of {} outside", outside, known), "", "", p});
    return;
  }
  for (const MotionNumber& n : g.numbers) {
    const bool always = n.name == "mean" || n.name == "standard deviation" || n.at == 0.05 || n.at == 0.5 || n.at == 0.95;
    if (!is_known(n) || (!always && !n.outside)) continue;
    const bool level = is_level(g, n);
    const auto displayed = [&](double value) { return level ? display_level(value, g.unit) : display_value(value, g.unit); };
    const auto number = [&](double value) { return to_range(displayed(value), displayed(n.high) - displayed(n.low)); };
    const auto with_unit = [&](const std::string& text) { return level ? with_level_unit(text, g.unit) : with_display_unit(text, g.unit); };
    table.rows.push_back({name, g.name == "amplitude" ? "amplitude, " + n.name : n.name, with_unit(number(n.measured)),
                          with_unit(number(n.low) + " to " + number(n.high)), n.outside ? "outside" : "", p});
    p.clear();
  }
}

}  // namespace

TableBlock method_table(const Comparison& c) {
  std::vector<Subject> subjects;
  for (const MethodSummary& m : c.methods) subjects.push_back({m.method, rows_of(m)});
  for (const auto& [name, trim] : c.reference_trims) subjects.push_back({name + " (reference)", {Row("trim", trim)}});
  return subjects_table("result", subjects);
}

Blocks curve_difference_blocks(const Comparison& c) {
  Blocks out;
  TableBlock table{columns("curve|between|>RMS [sigma]|>largest [sigma]|at|difference there|compared range")};
  for (const CurveDifference& d : c.curves) {
    table.rows.push_back({d.curve, d.a + " − " + d.b, fmt::format("{:.2f}", d.rms_sigmas), fmt::format("{:.2f}", d.max_sigmas),
                          place(d.at, d.from, d.to, d.of_unit), shown(d.difference), range(d.from, d.to, d.of_unit)});
  }
  if (!table.rows.empty()) out.subheading("Differences between curves");
  out.table(std::move(table));
  std::vector<std::string> left_out;
  for (const NotCompared& n : c.not_compared) left_out.push_back(n.what + ": " + n.why);
  if (!left_out.empty()) out.subheading("Not compared");
  out.list({left_out});
  return out;
}

Blocks blocks_of(const SimulatedMotion& motion) {
  Blocks out;
  out.heading("Simulated and measured motion");
  out.paragraph(
      fmt::format("Random motion cannot be matched sample by sample: a correct model must reproduce its statistics. {} runs of the "
                  "model fitted by {}; a small p means that it does not reproduce that group of statistics.",
                  motion.runs, motion.method));
  out.list({as_sentences(motion.sentences)});
  out.figures("statistics");
  TableBlock table{columns("series|statistic|measured|simulated, 95 %||>p of the group")};
  for (const MotionSeries& s : motion.series) {
    for (const MotionGroup& g : s.groups) add_group(s, g, table);
  }
  out.table(std::move(table));
  out.warnings(motion.notes);
  return out;
}

Blocks blocks_of(const Comparison& c) {
  Blocks out;
  out.heading("Results");
  out.table(method_table(c));
  std::vector<std::string> trims, parameters;
  for (const TrimDifference& d : c.trims) trims.push_back(d.sentence);
  for (const ParameterDifference& d : c.parameters) {
    if (!d.sentence.empty()) parameters.push_back(d.sentence);  // begins with the parameter's name
  }
  out.list({as_sentences(trims)});
  out.warnings(parameters);
  out.append(curve_difference_blocks(c));
  if (c.motion) out.append(blocks_of(*c.motion));
  return out;
}

}  // namespace misfit
