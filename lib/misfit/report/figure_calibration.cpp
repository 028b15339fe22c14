#include <fmt/format.h>

#include "misfit/core/units.h"
#include "misfit/report/figure_units.h"
#include "misfit/report/figures.h"

namespace misfit::report {
namespace {

using Keep = bool (*)(const CalibrationResidual&);
using Value = double (*)(const CalibrationResidual&);

double difference(const CalibrationResidual& r) { return r.measured - r.predicted; }
double measured(const CalibrationResidual& r) { return r.measured; }
double predicted(const CalibrationResidual& r) { return r.predicted; }
bool any(const CalibrationResidual&) { return true; }
bool used(const CalibrationResidual& r) { return r.used; }
bool set_aside(const CalibrationResidual& r) { return !r.used; }

/// Which residuals: point 1, 2, 3 (0: all) of coordinate 'y' or 'z'.
struct Which {
  int point;
  char coordinate;
};

void fill(Series& s, const Calibration& c, const Which& which, Keep keep, Value value) {
  for (const CalibrationResidual& r : c.residuals) {
    if (r.coordinate != which.coordinate || (which.point != 0 && r.point != which.point) || !keep(r)) continue;
    s.x.push_back(r.theta / kDegree);
    s.y.push_back(value(r));
  }
}

Figure sweep_figure(const std::string& name, const std::string& title) {
  Figure figure;
  figure.name = name;
  figure.title = title;
  figure.x_label = "angle of the rig theta";
  figure.x_unit = "deg";
  return figure;
}

bool has_coordinate(const Calibration& c, char coordinate) {
  for (const CalibrationResidual& r : c.residuals) {
    if (r.coordinate == coordinate) return true;
  }
  return false;
}

}  // namespace

Figure calibration_figure(const Calibration& calibration) {
  Figure figure = sweep_figure("calibration", "Calibration: reference points in the image");
  figure.caption =
      "Image coordinates of the three reference points of the static rig: measured (circles), predicted by the calibrated camera (lines).";
  for (const char coordinate : {'z', 'y'}) {
    if (!has_coordinate(calibration, coordinate) && coordinate == 'y') continue;
    Panel panel{.y_label = fmt::format("P_{}", coordinate), .y_unit = "px", .height = coordinate == 'z' ? 260.0 : 170.0};
    for (int point = 1; point <= 3; ++point) {
      const std::string colour = palette(point - 1);
      Series line{fmt::format("predicted_{}{}", point, coordinate), "", Style::line, colour, {}, {}, {}, {}, 1.4};
      Series marks{fmt::format("measured_{}{}", point, coordinate), fmt::format("point {}", point), Style::markers, colour, {}, {}, {}, {}};
      fill(line, calibration, {point, coordinate}, any, predicted);
      fill(marks, calibration, {point, coordinate}, any, measured);
      panel.series.insert(panel.series.end(), {std::move(line), std::move(marks)});
    }
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

Figure calibration_residual_figure(const Calibration& calibration) {
  Figure figure = sweep_figure("calibration_residuals", "Calibration: measured − predicted");
  figure.caption = fmt::format(
      "Residuals of the calibration per point and angle; RMS {:.2f} px. A trend indicates a camera parameter that should be free.",
      calibration.rms_px);
  for (const char coordinate : {'z', 'y'}) {
    if (!has_coordinate(calibration, coordinate) && coordinate == 'y') continue;
    Panel panel{.y_label = fmt::format("residual P_{}", coordinate), .y_unit = "px", .height = 190.0, .zero_line = true};
    for (int point = 1; point <= 3; ++point) {
      Series s{fmt::format("residual_{}{}", point, coordinate),
               fmt::format("point {}", point),
               Style::markers,
               palette(point - 1),
               {},
               {},
               {},
               {}};
      fill(s, calibration, {point, coordinate}, used, difference);
      panel.series.push_back(std::move(s));
    }
    Series outliers{fmt::format("outliers_{}", coordinate), "rejected", Style::markers, grey, {}, {}, {}, {}};
    fill(outliers, calibration, {0, coordinate}, set_aside, difference);
    if (!outliers.x.empty()) panel.series.push_back(std::move(outliers));
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

}  // namespace misfit::report
