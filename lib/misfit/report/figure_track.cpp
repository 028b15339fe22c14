#include <algorithm>
#include <cmath>

#include "misfit/core/file_name.h"
#include "misfit/report/figure_units.h"
#include "misfit/report/figures.h"

namespace misfit::report {
namespace {

/// Lost samples, drawn at the height `level`.
Series losses(const Track& track, double level) {
  Series s{"lost", "lost", Style::points, palette(1), {}, {}, {}, {}};
  for (std::size_t k = 0; k < track.t.size(); ++k) {
    if (track.ok[k]) continue;
    s.x.push_back(track.t[k]);
    s.y.push_back(level);
  }
  return s;
}

double lowest(const std::vector<double>& values) {
  double out = no_point;
  for (double v : values) {
    if (std::isfinite(v) && !(v > out)) out = v;
  }
  return std::isfinite(out) ? out : 0.0;
}

Panel place_panel(const char* label, const Track& track, const std::vector<double>& values, std::size_t colour) {
  Panel panel{.y_label = label, .y_unit = "px", .height = 180.0};
  panel.series.push_back({label, "", Style::line, palette(colour), track.t, values, {}, {}, 0.8});
  Series lost = losses(track, lowest(values));
  if (!lost.x.empty()) panel.series.push_back(std::move(lost));
  return panel;
}

}  // namespace

Figure track_figure(const std::string& experiment, const Track& track) {
  Figure figure;
  figure.name = "track_" + file_name_for(experiment);
  figure.title = experiment + ": the marker in the image";
  figure.caption =
      "P_y and P_z of the marker from the image centre, one sample per field or frame; lost samples are marked at the lower edge. Below, "
      "where it is known: the standard deviation of one coordinate at each sample.";
  figure.x_label = "time";
  figure.x_unit = std::string("s");
  Panel sigma{.y_label = "sigma", .y_unit = "px", .height = 110.0};
  sigma.series.push_back({"sigma", "", Style::points, palette(2), track.t, track.sigma, {}, {}});
  figure.panels = {place_panel("P_y", track, track.P_y, 0), place_panel("P_z", track, track.P_z, 0)};
  const bool known = std::any_of(track.sigma.begin(), track.sigma.end(), [](double v) { return std::isfinite(v); });
  if (known) figure.panels.push_back(std::move(sigma));
  return figure;
}

}  // namespace misfit::report
