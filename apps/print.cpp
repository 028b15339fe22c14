#include "apps/print.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "misfit/core/display.h"
#include "misfit/core/files.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/data/curve_coefficient.h"

namespace misfit {
namespace {

std::string shown(const Estimate& e) { return in_display_unit(e.value, e.unit, e.sigma); }

/// With what is not usual of it: no sigma, or an interval that is not ± 1.96 sigma.
std::string estimated(const Estimate& e) {
  std::string text = e.sigma > 0.0 ? shown(e) : shown(e) + " (sigma not available)";
  if (e.interval) text += ", 95 %: " + interval_in_display_unit(e.interval->first, e.interval->second, e.unit, e.sigma);
  return text;
}

std::string curve_text(const CurveEstimate& curve) {
  if (!curve.informative) return "not informative: " + curve.why;
  double lowest = NAN, highest = NAN;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (!(curve.count[i] > 0.0)) continue;
    if (!std::isfinite(lowest)) lowest = curve.x[i];
    highest = curve.x[i];
  }
  const std::string unit = display_unit(curve.of_unit);
  const double factor = unit == curve.of_unit ? 1.0 : convert(1.0, curve.of_unit, unit);
  return fmt::format("from {:.1f} to {:.1f} {} of {}", lowest * factor, highest * factor, unit, curve.of);
}

void add_estimates(const char* what, const std::map<std::string, Estimate>& estimates, std::vector<std::vector<std::string>>& rows) {
  for (const auto& [name, e] : estimates) {
    std::string text = shown(e);
    if (e.interval) text += ", 95 %: " + interval_in_display_unit(e.interval->first, e.interval->second, e.unit, e.sigma);
    rows.push_back({std::string(what) + " " + name, std::move(text)});
  }
}

std::string fit_text(const Fit& fit) {
  std::string out =
      fmt::format("{}  —  {}  ({:.2f} s, {} linearisations)\n", fit.method, to_string(fit.status), fit.seconds, fit.linearisations);
  out += wrap_text(fit.message, 110, "  ") + "\n";
  std::vector<std::vector<std::string>> rows{{"result", "value"}};
  if (fit.trim) rows.push_back({"trim", estimated(*fit.trim)});
  add_estimates("residual RMS", fit.rms, rows);
  add_estimates("validation RMS", fit.validation_rms, rows);
  add_estimates("random force", fit.force, rows);
  add_estimates("noise", fit.noise, rows);
  for (const auto& [name, e] : fit.parameters) {
    if (!is_curve_coefficient(name)) rows.push_back({name, estimated(e)});
  }
  for (const auto& curve : fit.curves) rows.push_back({"curve " + curve.name, curve_text(curve)});
  if (rows.size() > 1) out += align_columns(rows);
  return out + warnings_text(fit);
}

}  // namespace

std::string warnings_text(const Fit& fit) {
  std::string out;
  for (const auto& warning : fit.warnings) out += wrap_text("! " + warning, 110, "  ") + "\n";
  return out;
}

std::string calibration_text(const Calibration& c) {
  std::vector<std::vector<std::string>> rows{{"camera", "value"}};
  for (std::size_t i = 0; i < camera_parameter_names.size(); ++i) {
    const std::string name = camera_parameter_names[i];
    const bool free = std::find(c.names.begin(), c.names.end(), name) != c.names.end();
    if (free || c.value(name) != 0.0)
      rows.push_back({name, shown({c.value(name), c.sigma(name), camera_parameter_units[i]}) + (free ? "" : "  (given)")});
  }
  if (!c.residuals.empty()) {
    rows.push_back({"residual RMS", format_value(c.rms_px) + " px"});
    rows.push_back({"outliers", std::to_string(c.outliers) + " of " + std::to_string(c.residuals.size()) + " coordinates"});
  }
  std::string out = "calibration  —  " + c.message + "\n" + align_columns(rows);
  if (!c.tests.empty()) {
    std::vector<std::vector<std::string>> tests{{"tested", "drop", "p (corrected)", "selected"}};
    for (const auto& t : c.tests) tests.push_back({t.name, format_value(t.drop), format_probability(t.p_value), t.selected ? "yes" : "no"});
    out += align_columns(tests);
  }
  for (const auto& note : c.notes) out += wrap_text("! " + note, 110, "  ") + "\n";
  return out;
}

std::string track_text(const std::string& experiment, const TrackFacts& facts) {
  std::string out = "track of " + experiment + "\n";
  for (const auto& sentence : sentences(facts)) out += wrap_text(sentence, 110, "  ") + "\n";
  for (const auto& warning : facts.warnings) out += wrap_text("! " + warning, 110, "  ") + "\n";
  return out;
}

std::string attitude_text(const std::string& experiment, const Attitude& a) {
  const auto known = std::count_if(a.eta.begin(), a.eta.end(), [](double v) { return std::isfinite(v); });
  double sum = 0.0, squares = 0.0, n = 0.0;
  for (double v : a.alpha_T) {
    if (std::isfinite(v)) sum += v, squares += v * v, n += 1.0;
  }
  const double mean = n > 0.0 ? sum / n : NAN;
  constexpr double to_degrees = 180.0 / 3.14159265358979323846;
  std::string out = "attitude of " + experiment + "\n";
  out += align_columns({{"quantity", "value"},
                        {"samples read", std::to_string(known) + " of " + std::to_string(a.t.size())},
                        {"mean alpha_T", format_value(mean * to_degrees) + " deg"},
                        {"RMS of alpha_T about it",
                         format_value(std::sqrt(std::max(squares / std::max(n, 1.0) - mean * mean, 0.0)) * to_degrees) + " deg"}});
  for (const auto& note : a.notes) out += wrap_text("! " + note, 110, "  ") + "\n";
  return out;
}

std::string fits_text(const std::vector<Fit>& fits) {
  std::string out;
  for (const auto& fit : fits) out += (out.empty() ? "" : "\n") + fit_text(fit);
  return out;
}

int status_of(const std::vector<Fit>& fits) {
  const auto done = [](const Fit& fit) { return fit.usable(); };
  return fits.empty() || std::any_of(fits.begin(), fits.end(), done) ? 0 : 1;
}

void print_file(const std::filesystem::path& path) { std::cout << read_file(path); }

}  // namespace misfit
