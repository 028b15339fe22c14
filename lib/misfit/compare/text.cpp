#include "misfit/core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/compare/compare.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

using Cells = std::vector<std::vector<std::string>>;

std::string shown(const Estimate& e) {
  const std::string unit = display_unit(e.unit);
  const double factor = convert(1.0, e.unit, unit);
  return format_value(e.value * factor, e.sigma * factor);
}

void add_row(Cells& rows, const std::string& method, const std::string& what, const Estimate& e) {
  rows.push_back({method, what, shown(e), display_unit(e.unit)});
}

std::string number(const std::optional<double>& value) { return value ? fmt::format("{:.1f}", *value) : "not available"; }

std::string methods_text(const Comparison& c) {
  Cells rows = {{"method", "what", "value", "unit"}};
  for (const MethodSummary& m : c.methods) {
    rows.push_back({m.method, "status", to_string(m.status), ""});
    if (m.trim) add_row(rows, "", "trim", *m.trim);
    for (const auto& [name, value] : m.parameters) add_row(rows, "", name, value);
    for (const auto& [curve, slope] : m.slopes) add_row(rows, "", "slope of " + curve + " at trim", slope);
    for (const auto& [curve, value] : m.at_trim) add_row(rows, "", curve + " at trim", value);
    for (const auto& [channel, rms] : m.rms) add_row(rows, "", "rms " + channel, rms);
    for (const auto& [channel, rms] : m.validation_rms) add_row(rows, "", "validation rms " + channel, rms);
    if (m.loglik) rows.push_back({"", "log-likelihood", number(m.loglik), "-"});
    if (m.validation_loglik) rows.push_back({"", "held-out log-likelihood", number(m.validation_loglik), "-"});
  }
  for (const auto& [name, trim] : c.reference_trims) add_row(rows, name, "trim (reference)", trim);
  return align_columns(rows);
}

std::string curves_text(const Comparison& c) {
  if (c.curves.empty()) return "";
  Cells rows = {{"curve", "between", "rms [sigma]", "max [sigma]", "at", "difference there", "unit", "range"}};
  for (const CurveDifference& d : c.curves) {
    const std::string unit = display_unit(d.of_unit);
    const auto x = [&](double value) { return fmt::format("{:.3g}", convert(value, d.of_unit, unit)); };
    rows.push_back({d.curve, d.a + " − " + d.b, fmt::format("{:.2f}", d.rms_sigmas), fmt::format("{:.2f}", d.max_sigmas),
                    x(d.at) + " " + unit, shown(d.difference), display_unit(d.unit), x(d.from) + " … " + x(d.to) + " " + unit});
  }
  return align_columns(rows);
}

std::string as_text(double value, double factor) { return std::isfinite(value) ? fmt::format("{:.3g}", value * factor) : "–"; }

void add_group(const MotionSeries& s, const MotionGroup& g, Cells& rows) {
  const std::string unit = display_unit(g.unit);
  const double factor = unit == g.unit ? 1.0 : convert(1.0, g.unit, unit);
  const std::string p = fmt::format("{:.3f}", g.p_value);
  if (g.name == "autocorrelation" || g.name == "spectrum") {
    const auto outside = std::count_if(g.numbers.begin(), g.numbers.end(), [](const MotionNumber& n) { return n.outside; });
    rows.push_back({s.name, g.name, fmt::format("{} of {} outside", outside, g.numbers.size()), "", "", p});
    return;
  }
  bool first = true;
  for (const MotionNumber& n : g.numbers) {
    const bool always = n.name == "mean" || n.name == "standard deviation" || n.at == 0.05 || n.at == 0.5 || n.at == 0.95;
    if (!always && !n.outside) continue;
    rows.push_back({s.name, g.name == "amplitude" ? "amplitude, " + n.name : n.name, as_text(n.measured, factor) + " " + unit,
                    as_text(n.low, factor) + " … " + as_text(n.high, factor), n.outside ? "outside" : "", first ? p : ""});
    first = false;
  }
}

std::string motion_text(const SimulatedMotion& motion) {
  Cells rows = {{"series", "statistic", "measured", "simulated, 95 %", "", "p of the group"}};
  std::string experiment, out;
  for (const MotionSeries& s : motion.series) {
    if (s.experiment != experiment) rows.push_back({s.experiment, "", "", "", "", ""});
    experiment = s.experiment;
    for (const MotionGroup& g : s.groups) add_group(s, g, rows);
  }
  out = fmt::format("\nsimulated motion of the fitted model ({} runs) against the measured motion  ({:.1f} s)\n", motion.runs,
                    motion.seconds);
  if (rows.size() > 1) out += align_columns(rows);
  for (const auto& sentence : motion.sentences) out += wrap_text(sentence, 100, "  ") + "\n";
  for (const auto& note : motion.notes) out += wrap_text("! " + note, 100, "  ") + "\n";
  return out;
}

}  // namespace

std::string comparison_text(const Comparison& comparison) {
  std::string text = methods_text(comparison);
  if (!comparison.trims.empty()) text += "\n";
  for (const TrimDifference& d : comparison.trims) text += wrap_text(d.sentence, 100, "  ") + "\n";
  for (const ParameterDifference& d : comparison.parameters) {
    if (!d.sentence.empty()) text += "\n" + wrap_text("! " + d.sentence, 100, "  ") + "\n";
  }
  if (!comparison.curves.empty()) text += "\n";
  text += curves_text(comparison);
  if (!comparison.not_compared.empty()) text += "\n";
  for (const NotCompared& n : comparison.not_compared) text += wrap_text("not compared: " + n.what + " (" + n.why + ")", 100, "  ") + "\n";
  if (comparison.motion) text += motion_text(*comparison.motion);
  return text;
}

}  // namespace misfit
