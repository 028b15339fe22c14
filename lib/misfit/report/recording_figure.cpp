#include "misfit/report/recording_figure.h"

#include <fmt/format.h>

#include <limits>

#include "misfit/core/display.h"
#include "misfit/core/file_name.h"
#include "misfit/report/figure_units.h"

namespace misfit::report {
namespace {

/// More than one and a half of the usual steps since the sample before.
bool after_gap(const std::vector<double>& t, std::size_t k, double step) { return k > 0 && t[k] - t[k - 1] > 1.5 * step; }

/// A value with the place of the row before it broken, so that no line is drawn across a gap.
Series curve(const Column& column, const std::vector<double>& t, double step, std::size_t colour, const Interval& part) {
  Series s{as_key(column.name), "", Style::line, palette(colour), {}, {}, {}, {}, 1.2};
  const std::vector<double> values = display_values(column.values, column.unit.empty() ? "-" : column.unit);
  for (std::size_t k = 0; k < t.size(); ++k) {
    if (t[k] < part.from || t[k] > part.to) continue;
    if (!s.x.empty() && after_gap(t, k, step)) {
      s.x.push_back(t[k]);
      s.y.push_back(std::numeric_limits<double>::quiet_NaN());
    }
    s.x.push_back(t[k]);
    s.y.push_back(values[k]);
  }
  return s;
}

std::string use_of(const RecordingSurvey& survey, const std::string& name) {
  for (const auto& c : survey.columns) {
    if (c.name != name) continue;
    if (c.use == ColumnUse::input) return "input";
    if (c.use == ColumnUse::rate) return "rate of " + c.rate_of;
    return "output";
  }
  return "";
}

}  // namespace

Figure recording_figure(const RecordingSurvey& survey, std::size_t part, const std::string& name, const std::optional<Interval>& zoom) {
  const Table& table = survey.parts.at(part);
  const std::vector<double>& t = table.columns.front().values;
  const Interval all = zoom.value_or(Interval{t.front(), t.back()});
  Figure figure;
  figure.name = "data_" + file_name_for(name) + (zoom ? "_zoom" : "");
  figure.title = name + ": the recording" + (zoom ? " (part)" : "");
  figure.caption = fmt::format("Columns of {} as read: {} rows, sampling interval {:g} s.", name, t.size(), survey.step);
  figure.x_label = "time";
  figure.x_unit = std::string("s");
  for (std::size_t i = 1; i < table.columns.size(); ++i) {
    const Column& column = table.columns[i];
    const std::string unit = column.unit.empty() ? "-" : display_unit(column.unit);
    Panel panel{.y_label = column.name + " (" + use_of(survey, column.name) + ")", .y_unit = unit, .height = 170.0};
    panel.series.push_back(curve(column, t, survey.step, i - 1, all));
    figure.panels.push_back(std::move(panel));
  }
  for (std::size_t k = 1; k < t.size(); ++k) {
    constexpr std::size_t most = 5;
    if (!after_gap(t, k, survey.step) || t[k - 1] < all.from || t[k] > all.to || figure.notes.size() >= most) continue;
    figure.notes.push_back(fmt::format("no samples from {:g} s to {:g} s", t[k - 1], t[k]));
  }
  return figure;
}

}  // namespace misfit::report
