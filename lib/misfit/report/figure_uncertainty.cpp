#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/report/figure_units.h"
#include "misfit/report/figures_uncertainty.h"
#include "misfit/report/reference_series.h"

namespace misfit::report {
namespace {

/// `values` where `keep` holds, or beside such a place, so that two lines meet.
std::vector<double> kept(const std::vector<double>& values, const std::vector<bool>& keep) {
  std::vector<double> out(values.size(), no_point);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (keep[i] || (i > 0 && keep[i - 1]) || (i + 1 < values.size() && keep[i + 1])) out[i] = values[i];
  }
  return out;
}

struct Band {
  std::vector<double> x, mean, low, high, nominal;
  std::vector<bool> reached, rest;  ///< by at least half of the runs; the others
};

Band band_of(const SpreadCurve& c, const Uncertainty& u) {
  Band b{display_values(c.x, c.of_unit), display_values(c.mean, c.unit), {}, {}, display_values(c.nominal, c.unit), {}, {}};
  const std::vector<double> sigma = display_values(c.sigma, c.unit);
  const double half = 0.5 * static_cast<double>(u.runs - u.failed);
  for (std::size_t i = 0; i < b.x.size(); ++i) {
    b.low.push_back(b.mean[i] - 3.0 * sigma[i]);
    b.high.push_back(b.mean[i] + 3.0 * sigma[i]);
    b.reached.push_back(c.count[i] >= half);
    b.rest.push_back(!b.reached.back());
  }
  return b;
}

void add_trim(const SpreadNumber& trim, Panel& panel) {
  const double mean = display_value(trim.mean, trim.unit), reach = 3.0 * display_value(trim.sigma, trim.unit);
  if (!std::isfinite(mean) || !std::isfinite(reach)) return;
  const std::string legend = "trim, ± 3 sigma: " + in_display_unit(trim.mean, trim.unit, 3.0 * trim.sigma);
  panel.series.push_back({"trim", legend, Style::x_bars, palette(1), {mean}, {0.0}, {mean - reach}, {mean + reach}});
}

/// Of the band where at least half of the runs reach: a tail that few runs reach would flatten everything else.
std::optional<std::array<double, 2>> range_of(const Band& b) {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (std::size_t i = 0; i < b.x.size(); ++i) {
    for (const double v : {b.low[i], b.high[i], b.nominal[i]}) {
      if (!b.reached[i] || !std::isfinite(v)) continue;
      lo = std::min(lo, v);
      hi = std::max(hi, v);
    }
  }
  if (!(lo < hi)) return std::nullopt;
  const double margin = 0.08 * (hi - lo);
  return std::array<double, 2>{lo - margin, hi + margin};
}

void add_share(const VarianceShare& share, double place, Series& series) {
  constexpr double half = 0.32, percent = 100.0;
  series.x.push_back(percent * std::clamp(share.share, 0.0, 1.0));
  series.y.push_back(place);
  series.lo.push_back(place - half);
  series.hi.push_back(place + half);
}

Panel shares_panel(const SpreadNumber& number, std::size_t colour) {
  Panel panel;
  Series bars{as_key(number.name), "", Style::bars, palette(colour), {}, {}, {}, {}};
  auto place = static_cast<double>(number.shares.size()) + 1.0;
  for (const VarianceShare& share : number.shares) {
    panel.y_marks.push_back({place, share.name});
    add_share(share, place, bars);
    place -= 1.0;
  }
  panel.y_marks.push_back({place, "together"});
  add_share({"", number.rest, 0.0, 0.0}, place, bars);
  panel.series = {bars};
  panel.y_range = {0.4, static_cast<double>(number.shares.size()) + 1.6};
  panel.height = 60.0 + 30.0 * static_cast<double>(number.shares.size() + 1);
  return panel;
}

std::vector<const SpreadNumber*> shared_numbers(const Uncertainty& u) {
  std::vector<const SpreadNumber*> out;
  const auto take = [&](const SpreadNumber* n) {
    if (n != nullptr && !n->shares.empty() && out.size() < 2 && std::find(out.begin(), out.end(), n) == out.end()) out.push_back(n);
  };
  take(u.find("trim"));
  for (const SpreadCurve& curve : u.curves) {
    if (curve.trimmed) take(u.find("slope of " + curve.name));
  }
  for (const SpreadNumber& n : u.numbers) take(&n);
  return out;
}

Panel spread_panel(const SpreadCurve& curve, const Band& b) {
  Panel panel;
  panel.y_label = curve.name;
  panel.y_unit = display_unit(curve.unit);
  panel.zero_line = true;
  const std::string colour = palette(0);
  panel.series.push_back({"band", "± 3 sigma", Style::band, colour, b.x, {}, kept(b.low, b.reached), kept(b.high, b.reached)});
  if (std::find(b.rest.begin(), b.rest.end(), true) != b.rest.end()) {
    panel.series.push_back({"band_few",
                            "reached by fewer than half of the runs",
                            Style::pale_band,
                            colour,
                            b.x,
                            {},
                            kept(b.low, b.rest),
                            kept(b.high, b.rest)});
  }
  panel.series.push_back({"mean", "mean of the runs", Style::line, colour, b.x, b.mean, {}, {}});
  panel.series.push_back(
      {"nominal", curve.informative ? "nominal" : "nominal (not informative)", Style::dashed, black, b.x, b.nominal, {}, {}, 1.4});
  panel.y_range = range_of(b);
  return panel;
}

}  // namespace

Figure spread_figure(const SpreadCurve& curve, const Uncertainty& u, const std::vector<Reference>& references) {
  const Band b = band_of(curve, u);
  Figure figure;
  const auto first = std::find_if(u.curves.begin(), u.curves.end(), [&](const SpreadCurve& c) { return c.name == curve.name; });
  const bool another = first != u.curves.end() && first->of != curve.of;  // of the same name, drawn already
  figure.name = "uncertainty_" + as_key(curve.name) + (another ? "_" + as_key(curve.of) : "");
  figure.title = fmt::format("Propagated uncertainty of {}: {} runs, {}", curve.name, u.runs - u.failed, u.method);
  figure.caption =
      "Mean over the runs with its 3-sigma band, and the fit of the unperturbed study. The band contains "
      "the propagated uncertainty only, neither measurement noise nor model error.";
  figure.x_label = curve.of;
  figure.x_unit = display_unit(curve.of_unit);
  Panel panel = spread_panel(curve, b);
  const SpreadNumber* trim = u.find("trim");
  for (const Reference& reference : references) {
    if (reference.curve == curve.name && reference.of == curve.of && reference.unit == curve.unit) {
      panel.series.push_back(reference_series(reference, reference.name + " (reference), ± 1 sigma"));
    }
  }
  if (trim != nullptr && curve.trimmed && curve.of_unit == trim->unit) add_trim(*trim, panel);
  if (!b.x.empty()) figure.x_range = {b.x.front(), b.x.back()};
  figure.panels = {panel};
  if (!curve.informative) figure.notes.push_back(curve.name + " is not informative" + (curve.why.empty() ? "." : ": " + curve.why));
  return figure;
}

Figure shares_figure(const Uncertainty& u) {
  Figure figure;
  figure.name = "variance_shares";
  figure.title = "Variance decomposition";
  figure.caption =
      "First-order shares of the variance over the runs: the part that would vanish if the parameter were known exactly. "
      "Interactions: parameters acting jointly, and the sampling error of a finite number of runs. Signs and sigmas are in "
      "uncertainty.json.";
  const std::vector<const SpreadNumber*> numbers = shared_numbers(u);
  constexpr double most = 105.0;
  figure.x_range = {0.0, most};
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    figure.panels.push_back(shares_panel(*numbers[k], k));
    const std::string label = numbers[k]->name + ": share of the variance";
    if (k == 0) figure.x_label = label;
    if (k > 0) figure.panels.back().beside = OwnX{label + " [%]", {0.0, most}};
  }
  figure.x_unit = "%";
  return figure;
}

std::vector<Figure> uncertainty_figures(const Uncertainty& u, const std::vector<Reference>& references) {
  std::vector<Figure> out;
  for (const SpreadCurve& curve : u.curves) out.push_back(spread_figure(curve, u, references));
  if (!shared_numbers(u).empty()) out.push_back(shares_figure(u));
  make_names_unique(out);
  return out;
}

std::vector<std::string> write_uncertainty_figures(const std::filesystem::path& dir, const Uncertainty& u,
                                                   const std::vector<Reference>& references) {
  const std::vector<Figure> figures = uncertainty_figures(u, references);
  static_cast<void>(write_figures(dir, figures));
  return files_of(figures);
}

}  // namespace misfit::report
