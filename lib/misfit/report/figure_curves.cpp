#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/report/figure_units.h"
#include "misfit/report/figures.h"
#include "misfit/report/reference_series.h"

namespace misfit::report {
namespace {

struct Drawn {
  std::vector<double> x, value, lo, hi;
  std::vector<bool> visited;
};

Drawn drawn(const CurveEstimate& curve) {
  Drawn d{display_values(curve.x, curve.of_unit), display_values(curve.value, curve.unit), {}, {}, {}};
  const std::vector<double> sigma = display_values(curve.sigma, curve.unit);
  for (std::size_t i = 0; i < d.x.size(); ++i) {
    d.lo.push_back(d.value[i] - sigma[i]);
    d.hi.push_back(d.value[i] + sigma[i]);
  }
  // Visited: between the lowest and the highest place with a sample; single empty cells inside would only tear the drawing.
  const auto seen = [](double count) { return count > 0.0; };
  const auto first = std::find_if(curve.count.begin(), curve.count.end(), seen) - curve.count.begin();
  const auto behind = curve.count.rend() - std::find_if(curve.count.rbegin(), curve.count.rend(), seen);
  for (std::ptrdiff_t i = 0; i < std::ssize(d.x); ++i) d.visited.push_back(i >= first && i < behind);
  return d;
}

/// `values` where the point is visited (or, for `visited` false, where it or a neighbour is not, so that the two lines meet).
std::vector<double> part(const std::vector<double>& values, const Drawn& d, bool visited) {
  std::vector<double> result(values.size(), no_point);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool beside = (i > 0 && !d.visited[i - 1]) || (i + 1 < values.size() && !d.visited[i + 1]);
    if (visited ? d.visited[i] : !d.visited[i] || beside) result[i] = values[i];
  }
  return result;
}

bool any_finite(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

bool has_outside(const Panel& panel) {
  return std::any_of(panel.series.begin(), panel.series.end(), [](const Series& s) { return s.style == Style::dashed; });
}

void add_informative(const Fit& fit, const Drawn& d, const std::string& colour, Panel& panel) {
  const std::string key = as_key(fit.method);
  panel.series.push_back({key + "_band", "", Style::band, colour, d.x, {}, part(d.lo, d, true), part(d.hi, d, true)});
  panel.series.push_back({key, fit.method + ", ± 1 sigma", Style::line, colour, d.x, part(d.value, d, true), {}, {}});
  const std::vector<double> outside = part(d.value, d, false);
  if (any_finite(outside) && std::find(d.visited.begin(), d.visited.end(), false) != d.visited.end()) {
    const std::string legend = has_outside(panel) ? "" : "dashed: outside the operating range";
    panel.series.push_back({key + "_band_outside", "", Style::pale_band, colour, d.x, {}, part(d.lo, d, false), part(d.hi, d, false)});
    panel.series.push_back({key + "_outside", legend, Style::dashed, colour, d.x, outside, {}, {}, 1.4});
  }
}

void add_curve(const Fit& fit, const CurveEstimate& curve, const std::string& colour, Figure& figure) {
  const Drawn d = drawn(curve);
  Panel& panel = figure.panels.front();
  if (curve.informative) {
    add_informative(fit, d, colour, panel);
    return;
  }
  panel.series.push_back({as_key(fit.method), fit.method + ", not informative", Style::dotted, grey, d.x, d.value, {}, {}});
  figure.notes.push_back(fmt::format("{} of {} is not informative{}", curve.name, fit.method, curve.why.empty() ? "." : ": " + curve.why));
}

void add_trim(const std::string& name, const Estimate& trim, const std::string& colour, Panel& panel) {
  const double value = display_value(trim.value, trim.unit);
  const double sigma = std::isfinite(trim.sigma) ? display_value(trim.sigma, trim.unit) : 0.0;
  const std::string legend =
      "trim of " + name + ": " + in_display_unit(trim.value, trim.unit, std::isfinite(trim.sigma) ? trim.sigma : 0.0);
  panel.series.push_back({"trim_" + as_key(name), legend, Style::x_bars, colour, {value}, {0.0}, {value - sigma}, {value + sigma}});
}

/// Range of y from what the data carry: visited values with their bands (no wider than the values' own span on either side), the
/// references. Bands outside the visited range widen without limit and would flatten everything else.
std::optional<std::array<double, 2>> curve_range(const Panel& panel) {
  double lo = std::numeric_limits<double>::infinity();
  double hi = -lo;
  const auto take = [&](double v) {
    if (!std::isfinite(v)) return;
    lo = std::min(lo, v);
    hi = std::max(hi, v);
  };
  for (const Series& s : panel.series) {
    if (s.style == Style::line || s.style == Style::dotted || s.style == Style::error_bars) std::for_each(s.y.begin(), s.y.end(), take);
  }
  if (!(lo < hi)) return std::nullopt;
  const std::array<double, 2> core = {lo, hi};
  const double span = hi - lo;
  for (std::size_t k = 1; k < panel.series.size(); ++k) {
    if (panel.series[k - 1].style != Style::band || panel.series[k].style != Style::line) continue;
    for (std::size_t i = 0; i < panel.series[k].y.size(); ++i) {
      if (!std::isfinite(panel.series[k].y[i])) continue;
      take(std::max(panel.series[k - 1].lo[i], core[0] - 0.5 * span));
      take(std::min(panel.series[k - 1].hi[i], core[1] + 0.5 * span));
    }
  }
  const double margin = 0.05 * (hi - lo);
  return std::array<double, 2>{std::min(lo - margin, -margin), std::max(hi + margin, margin)};
}

/// The quantity of the first curve of this name: a further one has its own in the name of its figure.
std::string first_quantity(const std::string& curve, const std::vector<Fit>& fits, const std::vector<Reference>& references) {
  for (const Fit& fit : fits) {
    for (const CurveEstimate& c : fit.curves) {
      if (c.name == curve) return c.of;
    }
  }
  for (const Reference& reference : references) {
    if (reference.curve == curve) return reference.of;
  }
  return "";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> curve_names(const std::vector<Fit>& fits, const std::vector<Reference>& references) {
  std::vector<std::pair<std::string, std::string>> names;
  const auto add = [&](const std::string& curve, const std::string& of) {
    if (std::find(names.begin(), names.end(), std::pair(curve, of)) == names.end()) names.emplace_back(curve, of);
  };
  for (const Fit& fit : fits) {
    for (const CurveEstimate& curve : fit.curves) add(curve.name, curve.of);
  }
  for (const Reference& reference : references) add(reference.curve, reference.of);
  return names;
}

Figure curve_figure(const std::string& curve, const std::string& of, const std::vector<Fit>& fits,
                    const std::vector<Reference>& references) {
  Figure figure;
  figure.name = "curve_" + as_key(curve) + (of == first_quantity(curve, fits, references) ? "" : "_of_" + as_key(of));
  figure.title = curve + " against " + of;
  figure.caption = curve + " as estimated by each method, with bands of one standard deviation. Dashed: outside the operating range.";
  figure.x_label = of;
  Panel panel;
  panel.y_label = curve;
  panel.zero_line = true;
  panel.height = 400.0;
  figure.panels.push_back(panel);
  for (std::size_t k = 0; k < fits.size(); ++k) {
    if (!fits[k].usable()) figure.notes.push_back(fits[k].method + " " + to_string(fits[k].status) + ": " + fits[k].message);
    for (const CurveEstimate& c : fits[k].curves) {
      if (c.name != curve || c.of != of || !fits[k].usable()) continue;
      figure.x_unit = display_unit(c.of_unit);
      figure.panels.front().y_unit = display_unit(c.unit);
      add_curve(fits[k], c, palette(k), figure);
    }
  }
  for (const Reference& reference : references) {
    if (reference.curve != curve || reference.of != of) continue;
    figure.x_unit = display_unit(reference.of_unit);
    figure.panels.front().y_unit = display_unit(reference.unit);
    figure.panels.front().series.push_back(reference_series(reference, reference.name + " (reference)"));
  }
  figure.panels.front().y_range = curve_range(figure.panels.front());
  for (std::size_t k = 0; k < fits.size(); ++k) {
    const bool trimmed = std::any_of(fits[k].curves.begin(), fits[k].curves.end(),
                                     [&](const CurveEstimate& c) { return c.trimmed && c.name == curve && c.of == of; });
    if (trimmed && fits[k].usable() && fits[k].trim) add_trim(fits[k].method, *fits[k].trim, palette(k), figure.panels.front());
  }
  for (const Reference& reference : references) {
    if (reference.curve == curve && reference.of == of && reference.trim)
      add_trim(reference.name, *reference.trim, black, figure.panels.front());
  }
  return figure;
}

}  // namespace misfit::report
