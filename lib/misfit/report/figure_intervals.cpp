#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/report/figure_units.h"
#include "misfit/report/figures_intervals.h"

namespace misfit::report {
namespace {

constexpr double two_sided = 1.959964;  // of 95 %
constexpr double limit_95 = 3.841459;   // chi², 1 degree of freedom

/// `values` in the unit drawn, NaN outside the visited range.
std::vector<double> visited(const std::vector<double>& values, const BootstrapCurve& curve) {
  std::vector<double> out = display_values(values, curve.unit);
  const auto seen = [](double count) { return count > 0.0; };
  const auto first = std::find_if(curve.count.begin(), curve.count.end(), seen) - curve.count.begin();
  const auto behind = curve.count.rend() - std::find_if(curve.count.rbegin(), curve.count.rend(), seen);
  for (std::ptrdiff_t i = 0; i < std::ssize(out); ++i) {
    if (i < first || i >= behind) out[i] = no_point;
  }
  return out;
}

void add_bootstrap(const Bootstrap& bootstrap, const BootstrapCurve& curve, const std::string& colour, Figure& figure) {
  Panel& panel = figure.panels.front();
  const std::string key = as_key(bootstrap.method);
  const std::vector<double> x = display_values(curve.x, curve.of_unit);
  std::vector<double> below, above;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    below.push_back(curve.value[i] - two_sided * curve.fit_sigma[i]);
    above.push_back(curve.value[i] + two_sided * curve.fit_sigma[i]);
  }
  panel.series.push_back({key + "_band",
                          bootstrap.method + ", 95 % of the runs",
                          Style::band,
                          colour,
                          x,
                          {},
                          visited(curve.lower, curve),
                          visited(curve.upper, curve)});
  panel.series.push_back(
      {key + "_mean", bootstrap.method + ", mean of the runs", Style::line, colour, x, visited(curve.mean, curve), {}, {}});
  panel.series.push_back({key + "_below", bootstrap.method + ", fit ± 1.96 sigma", Style::dotted, black, x, visited(below, curve), {}, {}});
  panel.series.push_back({key + "_above", "", Style::dotted, black, x, visited(above, curve), {}, {}});
  figure.notes.push_back(fmt::format("{}: {} runs of {}, blocks of {} samples{}.", bootstrap.method, bootstrap.runs, bootstrap.how,
                                     bootstrap.block, bootstrap.failed > 0 ? fmt::format("; {} gave no fit", bootstrap.failed) : ""));
}

}  // namespace

Figure bootstrap_figure(const std::string& curve, const std::vector<Bootstrap>& bootstraps) {
  Figure figure;
  figure.name = "bootstrap_" + as_key(curve);
  figure.title = "Block bootstrap: " + curve;
  figure.caption = "The curve over replicas of the data (blocks keep the residual autocorrelation); dotted: the interval of the fit.";
  figure.panels.emplace_back();
  std::size_t colour = 0;
  for (const auto& bootstrap : bootstraps) {
    for (const auto& c : bootstrap.curves) {
      if (c.name != curve) continue;
      figure.x_label = c.of;
      figure.x_unit = display_unit(c.of_unit);
      figure.panels.front().y_label = c.name;
      figure.panels.front().y_unit = display_unit(c.unit);
      add_bootstrap(bootstrap, c, palette(colour++), figure);
    }
  }
  figure.panels.front().zero_line = true;
  return figure;
}

Figure profile_figure(const LikelihoodProfile& p) {
  Figure figure;
  figure.name = "profile_" + as_key(p.method) + "_" + as_key(p.parameter);
  figure.title = "Profile likelihood: " + p.parameter + ", " + p.method;
  figure.caption = "Drop 2 (log L of the fit − log L) with the parameter fixed at each value and all others re-estimated.";
  figure.x_label = p.parameter;
  figure.x_unit = display_unit(p.unit);
  Panel panel;
  panel.y_label = p.scale == 1.0 ? "drop" : "drop/scale";
  panel.y_unit = "-";
  const std::vector<double> x = display_values(p.value, p.unit);
  std::vector<double> drop;
  for (double d : p.drop) drop.push_back(d / p.scale);
  const auto [least, most] = std::minmax_element(p.value.begin(), p.value.end());
  std::vector<double> fine, parabola;
  constexpr int points = 100;
  for (int i = 0; i <= points && !p.value.empty() && p.sigma > 0.0; ++i) {
    fine.push_back(*least + (*most - *least) * i / points);
    parabola.push_back(std::pow((fine.back() - p.best) / p.sigma, 2));
  }
  panel.series.push_back({"profile", "all others re-estimated", Style::line, palette(0), x, drop, {}, {}});
  panel.series.push_back({"points", "", Style::markers, palette(0), x, drop, {}, {}});
  panel.series.push_back({"parabola", "sigma of the fit", Style::dotted, black, display_values(fine, p.unit), parabola, {}, {}});
  const std::vector<double> ends = display_values({p.lower, p.best, p.upper}, p.unit);
  panel.series.push_back({"interval",
                          fmt::format("95 %: {} to {}", p.lower_found ? in_display_unit(p.lower, p.unit) : "not reached",
                                      p.upper_found ? in_display_unit(p.upper, p.unit) : "not reached"),
                          Style::x_bars,
                          palette(1),
                          {ends[1]},
                          {limit_95},
                          {ends[0]},
                          {ends[2]}});
  panel.series.push_back({"limit", "", Style::dashed, grey, x, std::vector<double>(x.size(), limit_95), {}, {}});
  figure.panels.push_back(std::move(panel));
  figure.notes = p.words;
  return figure;
}

namespace {

/// Logarithmic in both directions from 0.
double start_place(double drop) { return std::copysign(std::log10(1.0 + std::abs(drop)), drop); }

void add_start_axis(const MultiStart& s, Panel& panel) {
  const double least = std::min(s.drop.empty() ? 0.0 : s.drop.front(), -1.0), most = std::max(s.drop.empty() ? 0.0 : s.drop.back(), 10.0);
  for (const double sign : {-1.0, 1.0}) {
    const double end = sign < 0.0 ? -least : most;
    for (double size = 1.0; size <= 10.0 * end; size *= 10.0)
      panel.y_marks.push_back({start_place(sign * size), fmt::format("{:g}", sign * size)});
  }
  panel.y_marks.push_back({0.0, "0"});
  constexpr double beyond = 1.3;
  panel.y_range = {start_place(beyond * least), start_place(beyond * most)};
}

}  // namespace

Figure starts_figure(const MultiStart& s) {
  Figure figure;
  figure.name = "starts_" + as_key(s.method);
  figure.title = "Random starts: " + s.method;
  figure.caption =
      "Maxima reached from random starting values, as the drop 2 (log L of the fit − log L). All at 0: one maximum, which the "
      "fit has reached. Below 0: the fit is not at the global maximum.";
  figure.x_label = "start, best first";
  figure.x_unit = "-";
  Panel panel;
  panel.y_label = "drop";
  panel.y_unit = "-";
  panel.zero_line = true;
  Series same{"same", "reach the reported maximum", Style::markers, palette(0), {}, {}, {}, {}}, other = same;
  other.key = "other";
  other.legend = "end elsewhere";
  other.colour = palette(1);
  for (std::size_t i = 0; i < s.drop.size(); ++i) {
    Series& to = std::abs(s.drop[i]) > kSameMaximum ? other : same;
    to.x.push_back(static_cast<double>(i + 1));
    to.y.push_back(start_place(s.drop[i]));
  }
  add_start_axis(s, panel);
  if (!same.x.empty()) panel.series.push_back(std::move(same));
  if (!other.x.empty()) panel.series.push_back(std::move(other));
  figure.panels.push_back(std::move(panel));
  figure.x_range = {0.0, static_cast<double>(s.drop.size() + 1)};
  figure.notes = s.words;
  if (s.failed > 0) figure.notes.push_back(fmt::format("{} of {} starts did not converge and are omitted.", s.failed, s.runs));
  return figure;
}

std::vector<Figure> interval_figures(const Resampling& resampling) {
  std::vector<Figure> figures;
  std::set<std::string> curves;
  for (const auto& b : resampling.bootstraps) {
    for (const auto& c : b.curves) curves.insert(c.name);
  }
  for (const auto& curve : curves) figures.push_back(bootstrap_figure(curve, resampling.bootstraps));
  for (const auto& p : resampling.profiles) figures.push_back(profile_figure(p));
  for (const auto& s : resampling.starts) figures.push_back(starts_figure(s));
  make_names_unique(figures);
  return figures;
}

std::vector<std::string> write_interval_figures(const std::filesystem::path& dir, const Resampling& resampling) {
  const std::vector<Figure> figures = interval_figures(resampling);
  static_cast<void>(write_figures(dir, figures));
  return files_of(figures);
}

}  // namespace misfit::report
