#include <fmt/format.h>

#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/file_name.h"
#include "misfit/report/figure_units.h"
#include "misfit/report/figures_simulated.h"

namespace misfit::report {
namespace {

struct Look {
  const char* group;
  const char* title;
  const char* caption;
  const char* x_label;
  const char* x_unit;
};
constexpr Look looks[] = {{"distribution", "Distribution of the motion", "Quantiles of the motion.", "share of the time", "-"},
                          {"autocorrelation", "Autocorrelation of the motion", "Autocorrelation of the motion.", "lag", "s"},
                          {"spectrum", "Spectrum of the motion", "Power spectral density of the motion.", "frequency", "Hz"}};

Series empty(const std::string& key, const std::string& legend, Style style, const std::string& colour) {
  return {key, legend, style, colour, {}, {}, {}, {}};
}

Panel panel_of(const MotionSeries& series, const MotionGroup& group) {
  const bool levels = !group.numbers.empty() && is_level(group, group.numbers.back());
  const auto drawn = [&](double value) { return levels ? display_level(value, group.unit) : display_value(value, group.unit); };
  const std::string key = as_key(series.name);
  Series band = empty(key + "_band", fmt::format("{}: 95 % of the simulated motions", series.name), Style::band, palette(0));
  Series middle = empty(key + "_median", "", Style::line, palette(0));
  Series measured = empty(key + "_measured", fmt::format("measured (p = {:.3f})", group.p_value), Style::markers, black);
  Series outside = empty(key + "_outside", "measured, outside the band", Style::markers, palette(1));
  for (const MotionNumber& n : group.numbers) {
    if (!std::isfinite(n.at)) continue;
    for (Series* s : {&band, &middle}) s->x.push_back(n.at);
    band.lo.push_back(drawn(n.low));
    band.hi.push_back(drawn(n.high));
    middle.y.push_back(drawn(n.median));
    Series& points = n.outside ? outside : measured;
    points.x.push_back(n.at);
    points.y.push_back(drawn(n.measured));
  }
  const std::string unit = levels ? display_level_unit(group.unit) : display_unit(group.unit);
  Panel panel{.y_label = series.name, .y_unit = unit, .series = {std::move(band), std::move(middle), std::move(measured)}, .height = 170.0};
  if (!outside.x.empty()) panel.series.push_back(std::move(outside));
  panel.zero_line = group.name == "autocorrelation";
  return panel;
}

}  // namespace

Figure simulated_figure(const SimulatedMotion& motion, const std::string& experiment, const std::string& group) {
  Figure figure;
  figure.name = "simulated_" + as_key(group) + "_" + file_name_for(experiment);
  for (const Look& look : looks) {
    if (group != look.group) continue;
    figure.title = fmt::format("{}: {}", look.title, experiment);
    figure.caption =
        fmt::format("{} The band holds 95 % of {} motions simulated with the model fitted by {}, with its random force and noise.",
                    look.caption, motion.runs, motion.method);
    figure.x_label = look.x_label;
    figure.x_unit = look.x_unit;
  }
  for (const MotionSeries& series : motion.series) {
    for (const MotionGroup& g : series.groups) {
      if (series.experiment == experiment && g.name == group) figure.panels.push_back(panel_of(series, g));
    }
  }
  return figure;
}

}  // namespace misfit::report
