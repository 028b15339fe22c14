#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "misfit/report/figure_units.h"
#include "misfit/report/figures_discovery.h"
#include "misfit/show/rows.h"

namespace misfit::report {
namespace {

constexpr std::size_t far_ahead = 3;  // of kLadderSteps: 8 steps; beyond, random motion has forgotten where it was

std::string added_to(const Rung& rung) {
  constexpr const char* system = "system:";
  if (rung.added.empty()) return rung.system;
  return "+ " + (rung.added.starts_with(system) ? rung.added.substr(std::string(system).size()) : rung.added);
}

/// What the strengths of the random force are called, by their units: with a port, of the first rung that has one, where they are several.
std::map<std::string, std::string> force_names(const Ladder& ladder) {
  std::map<std::string, std::string> out;
  for (const Rung& rung : ladder.rungs) {
    for (const ForceStrength& f : force_strengths(rung.force)) out.emplace(f.strength.unit, "random force on " + f.port);
  }
  if (out.size() == 1) out.begin()->second = "random force";
  return out;
}

void add_point(Series& series, double x, double value, double half) {
  series.x.push_back(x);
  series.y.push_back(value);
  series.lo.push_back(value - half);
  series.hi.push_back(value + half);
}

/// A box about x: width in rungs.
void add_box(Series& series, double x, double value, double width) {
  series.x.push_back(x);
  series.y.push_back(value);
  series.lo.push_back(x - 0.5 * width);
  series.hi.push_back(x + 0.5 * width);
}

/// Series are handed out by reference while others are added: room for all of them from the start.
constexpr std::size_t max_series = 16;

struct SeriesLook {
  std::string key, legend;
  Style style;
  std::string colour;
};

Panel& panel_for(std::vector<Panel>& panels, const std::string& label, const std::string& unit) {
  for (Panel& panel : panels) {
    if (panel.y_label == label && panel.y_unit == unit) return panel;
  }
  panels.push_back({label, unit, {}, std::nullopt, 0.0, 150.0, false, {}});
  panels.back().series.reserve(max_series);
  return panels.back();
}

/// The series of the panel that is called so; a new one where there is none.
Series& series_for(Panel& panel, const SeriesLook& look) {
  for (Series& s : panel.series) {
    if (s.key == look.key) return s;
  }
  panel.series.push_back({look.key, look.legend, look.style, look.colour, {}, {}, {}, {}});
  return panel.series.back();
}

void add_force(const Rung& rung, const std::map<std::string, std::string>& names, std::vector<Panel>& panels) {
  for (const auto& [port, e] : force_strengths(rung.force)) {
    const std::string unit = display_unit(e.unit);
    const std::string& name = names.at(e.unit);
    const double factor = convert(1.0, e.unit, unit);
    const std::string key = names.size() == 1 ? "force" : as_key(name);
    Series& series = series_for(panel_for(panels, name, unit), {key, "remaining " + name + ", ± 1 sigma", Style::error_bars, palette(1)});
    add_point(series, rung.id, e.value * factor, e.sigma * factor);
  }
}

/// Predicted and actual drop side by side.
void add_drop(const Rung& rung, std::vector<Panel>& panels) {
  constexpr double width = 0.25;
  if (!rung.predicted_drop && !rung.actual_drop) return;
  Panel& panel = panel_for(panels, "drop", "");
  const auto add = [&](const char* key, const char* legend, const std::string& colour, double side, double drop) {
    add_box(series_for(panel, {key, legend, Style::boxes, colour}), rung.id + 0.5 * side * width, drop, 0.9 * width);
  };
  if (rung.predicted_drop) add("predicted_drop", "drop, predicted", grey, -1.0, *rung.predicted_drop);
  if (rung.actual_drop) add("actual_drop", "drop, after refitting", palette(2), 1.0, *rung.actual_drop);
}

/// How the errors of a ladder are drawn.
struct Errors {
  bool relative = false;                ///< systems with other channels: each channel over its first value
  std::map<std::string, double> first;  ///< label + channel → first value
  std::vector<std::string> channels;    ///< in the order of their colours
};

bool channels_change(const Ladder& ladder) {
  const auto same = [&](const Rung& rung) {
    return std::equal(rung.rms.begin(), rung.rms.end(), ladder.rungs.front().rms.begin(), ladder.rungs.front().rms.end(),
                      [](const auto& a, const auto& b) { return a.first == b.first; });
  };
  return !std::all_of(ladder.rungs.begin(), ladder.rungs.end(), same);
}

std::string colour_of(const std::string& channel, Errors& errors) {
  const auto found = std::find(errors.channels.begin(), errors.channels.end(), channel);
  const std::size_t place = found - errors.channels.begin();
  if (found == errors.channels.end()) errors.channels.push_back(channel);
  return palette(place == 1 ? 2 : place == 2 ? 3 : place);  // 1 is the random force
}

/// What one channel of a rung adds to the panel of its unit; `ahead`: "8 samples ahead".
struct ChannelError {
  std::string ahead, channel;
  Estimate rms;
  std::size_t place = 0;  ///< among those of the rung
};

/// One marker per channel, side by side; or, relative, a line of markers.
void add_channel(const Rung& rung, const ChannelError& error, std::vector<Panel>& panels, Errors& errors) {
  const Estimate& e = error.rms;
  const std::string key = as_key(error.channel + "_RMS, " + error.ahead), legend = error.channel + ", " + error.ahead;
  const std::string colour = colour_of(error.channel, errors);
  if (errors.relative) {
    const double first = errors.first.emplace(key, e.value).first->second;
    Panel& panel = panel_for(panels, "RMS", "% of first");
    for (const Style style : {Style::line, Style::markers}) {
      const bool line = style == Style::line;
      Series& series = series_for(panel, {key + (line ? "_line" : ""), line ? "" : legend, style, colour});
      series.x.push_back(rung.id);
      series.y.push_back(100.0 * e.value / first);
    }
    return;
  }
  const std::string unit = display_unit(e.unit);
  constexpr double all = 0.3;
  const double width = all / static_cast<double>(std::max<std::size_t>(rung.rms.size(), 1));
  Series& series = series_for(panel_for(panels, "RMS", unit), {key, legend, Style::markers, colour});
  series.x.push_back(rung.id - 0.5 * all + (static_cast<double>(error.place) + 0.5) * width);
  series.y.push_back(e.value * convert(1.0, e.unit, unit));
}

void add_errors(const Rung& rung, std::vector<Panel>& near, std::vector<Panel>& far, Errors& errors) {
  std::size_t place = 0;
  for (const auto& [channel, e] : rung.rms) {
    add_channel(rung, {"one sample ahead", channel, e, place}, near, errors);
    const auto steps = rung.k_step.find(channel);
    if (steps != rung.k_step.end() && steps->second.size() > far_ahead) {
      const std::string ahead = fmt::format("{} samples ahead", kLadderSteps[far_ahead]);
      add_channel(rung, {ahead, channel, {steps->second[far_ahead], 0.0, e.unit}, place}, far, errors);
    }
    ++place;
  }
}

void add_trim(const Rung& rung, std::vector<Panel>& panels) {
  if (!rung.trim) return;
  constexpr double of_95_percent = 1.96;
  const std::string unit = display_unit(rung.trim->unit);
  const double factor = convert(1.0, rung.trim->unit, unit);
  Series& series = series_for(panel_for(panels, "trim", unit), {"trim", "trim, 95 % interval", Style::error_bars, palette(0)});
  add_point(series, rung.id, rung.trim->value * factor, of_95_percent * rung.trim->sigma * factor);
}

/// Least and largest of what is drawn.
std::array<double, 2> extent_with_bars(const Panel& panel) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::array<double, 2> out{infinite, -infinite};
  for (const Series& s : panel.series) {
    for (const auto* values : {&s.y, &s.lo, &s.hi}) {
      if (s.style == Style::boxes && values != &s.y) continue;  // these run along x
      for (const double v : *values) {
        if (std::isfinite(v)) out = {std::min(out[0], v), std::max(out[1], v)};
      }
    }
  }
  return out;
}

/// Drops are bars and begin at 0. The others are points: about their values, so that a small change is seen, but at least a tenth of the
/// value high, so that it does not look large; an amount that falls to a fraction begins at 0.
void set_range(Panel& panel) {
  auto [low, high] = extent_with_bars(panel);
  constexpr double min_drop = 10.0, least_height = 0.1, fraction = 0.5;
  if (panel.y_label == "drop") {
    low = std::min(low, 0.0);
    high = std::max(high, min_drop);  // less is nothing, and is not to look like much
  } else if (panel.y_label != "trim") {
    if (low < fraction * high && !panel.y_unit.starts_with("%")) low = std::min(low, 0.0);
    const double lacking = std::max(least_height * std::abs(high) - (high - low), 0.0);
    low -= 0.5 * lacking;
    high += 0.5 * lacking;
  }
  if (!(high > low) || !std::isfinite(high - low)) return;
  const double room = 0.08 * (high - low);
  panel.y_range = {low == 0.0 ? 0.0 : low - room, high + room};
}

}  // namespace

Figure ladder_figure(const Ladder& ladder) {
  Figure figure;
  figure.name = "ladder";
  figure.title = "Ladder: unexplained force and prediction errors";
  figure.caption =
      "Each rung adds one effect to its parent. Drop = 2 (log-likelihood with the effect − without); a change of system has none. The "
      "random "
      "force is the part of the excitation that the model does not explain; errors are of predictions from the filtered state. Axes of "
      "points need not begin at 0; they are at least a tenth of the value high.";
  figure.x_label = "model";
  std::vector<Panel> drop, force, near, far, trim;
  const auto names = force_names(ladder);
  Errors errors;
  errors.relative = channels_change(ladder);
  if (errors.relative)
    figure.caption +=
        " Its systems predict different channels: each error is relative to that of the first rung that predicts the channel.";
  for (const Rung& rung : ladder.rungs) {
    figure.x_marks.push_back({static_cast<double>(rung.id), added_to(rung)});
    add_drop(rung, drop);
    add_force(rung, names, force);
    add_errors(rung, near, far, errors);
    add_trim(rung, trim);
  }
  for (auto* panels : {&drop, &force, &near, &far, &trim}) {
    for (Panel& panel : *panels) {
      set_range(panel);
      figure.panels.push_back(std::move(panel));
    }
  }
  const double last = ladder.rungs.empty() ? 1.0 : ladder.rungs.back().id;
  figure.x_range = {-0.5, last + 0.5};
  return figure;
}

}  // namespace misfit::report
