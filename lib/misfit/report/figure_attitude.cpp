#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/file_name.h"
#include "misfit/report/figure_units.h"
#include "misfit/report/figures.h"

namespace misfit::report {
namespace {

std::vector<double> degrees(const std::vector<double>& radians) { return display_values(radians, "rad"); }

Figure time_figure(const std::string& name, const std::string& experiment, const std::string& title) {
  Figure figure;
  figure.name = as_key(name) + "_" + file_name_for(experiment);
  figure.title = experiment + ": " + title;
  figure.x_label = "time";
  figure.x_unit = std::string("s");  // g++ 12 warns wrongly about a one-letter literal assigned
  return figure;
}

Panel angle_panel(const std::string& label, double height) { return {label, "deg", {}, std::nullopt, 0.0, height, false}; }

Series part_of(const Series& whole, const Interval& part) {
  Series s = whole;
  s.x.clear();
  s.y.clear();
  for (std::size_t i = 0; i < whole.x.size(); ++i) {
    if (whole.x[i] < part.from || whole.x[i] > part.to) continue;
    s.x.push_back(whole.x[i]);
    s.y.push_back(whole.y[i]);
  }
  return s;
}

/// A clock angle jumps from 180 to −180: no line is drawn across.
std::vector<double> broken_at_jumps(std::vector<double> phi) {
  std::vector<double> result = phi;
  for (std::size_t i = 1; i < phi.size(); ++i) {
    if (std::abs(phi[i] - phi[i - 1]) > 180.0) result[i] = no_point;
  }
  return result;
}

}  // namespace

Figure orientation_figure(const std::string& experiment, const Attitude& a, const Interval& part) {
  Figure figure = time_figure("orientation", experiment, "orientation of the axis (part)");
  figure.caption = "Pitch theta and yaw psi of the axis: points from the images, line: three-point average.";
  const auto panel = [&](const char* label, const std::vector<double>& raw, const std::vector<double>& mean, std::size_t colour) {
    Panel p = angle_panel(label, 200.0);
    const std::string key = label;
    p.series.push_back(part_of({key + "_read", key + ", as read", Style::markers, palette(colour), a.t, degrees(raw), {}, {}}, part));
    p.series.push_back(
        part_of({key + "_mean", key + ", three-point average", Style::line, palette(colour), a.t, degrees(mean), {}, {}, 1.6}, part));
    return p;
  };
  figure.panels = {panel("theta", a.theta, a.theta_mean, 0), panel("psi", a.psi, a.psi_mean, 1)};
  return figure;
}

Figure path_figure(const std::string& experiment, const Attitude& a) {
  Figure figure;
  figure.name = "path_" + file_name_for(experiment);
  figure.title = experiment + ": path of the axis";
  figure.caption = "Pitch against yaw over the whole record (three-point averages): the path of the apex about the swivel.";
  figure.x_label = "psi";
  figure.x_unit = "deg";
  figure.equal_axes = true;
  Panel panel = angle_panel("theta", 700.0);
  panel.zero_line = true;
  panel.series.push_back({"path", "", Style::line, palette(0), degrees(a.psi_mean), degrees(a.theta_mean), {}, {}, 0.6});
  figure.panels.push_back(std::move(panel));
  return figure;
}

Figure history_figure(const std::string& experiment, const Attitude& a) {
  Figure figure = time_figure("history", experiment, "total angle of attack and clock angle");
  figure.caption = "Total angle of attack alpha_T and clock angle phi (zero where psi = 0 and theta > 0) over the whole record.";
  Panel tilt = angle_panel("alpha_T", 230.0);
  tilt.series.push_back({"alpha_T", "", Style::line, palette(0), a.t, degrees(a.alpha_T), {}, {}, 1.0});
  Panel clock = angle_panel("phi", 180.0);
  clock.y_range = std::array<double, 2>{-180.0, 180.0};
  clock.y_step = 90.0;
  clock.series.push_back({"phi", "", Style::line, palette(1), a.t, broken_at_jumps(degrees(a.phi)), {}, {}, 1.0});
  figure.panels = {std::move(tilt), std::move(clock)};
  return figure;
}

Figure histogram_figure(const std::string& experiment, const Attitude& a) {
  constexpr double bin = 0.5;  // [deg]
  Figure figure;
  figure.name = "histogram_" + file_name_for(experiment);
  figure.title = experiment + ": samples per " + fmt::format("{}", bin) + " deg of alpha_T";
  figure.caption = "Number of samples per angle: curves are uncertain where there are few.";
  figure.x_label = "alpha_T";
  figure.x_unit = "deg";
  std::vector<double> counts;
  for (const double alpha : degrees(a.alpha_T)) {
    if (!std::isfinite(alpha)) continue;
    const auto k = static_cast<std::size_t>(std::max(0.0, alpha) / bin);
    if (k >= counts.size()) counts.resize(k + 1, 0.0);
    counts[k] += 1.0;
  }
  Series s{"samples", "", Style::boxes, palette(0), {}, counts, {}, {}};
  for (std::size_t k = 0; k < counts.size(); ++k) {
    s.lo.push_back(bin * static_cast<double>(k));
    s.hi.push_back(s.lo.back() + bin);
    s.x.push_back(s.lo.back() + 0.5 * bin);
  }
  figure.panels.push_back({"samples", "count", {std::move(s)}, std::nullopt, 0.0, 220.0, false});
  return figure;
}

}  // namespace misfit::report
