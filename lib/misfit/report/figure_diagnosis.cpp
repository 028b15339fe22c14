#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "misfit/core/display.h"
#include "misfit/core/file_name.h"
#include "misfit/core/text.h"
#include "misfit/report/figure_units.h"
#include "misfit/report/figures_discovery.h"

namespace misfit::report {
namespace {

/// Half of the distance to the neighbours: how wide a place is drawn.
std::vector<double> half_steps(const std::vector<double>& x) {
  std::vector<double> out(x.size(), 0.5);
  for (std::size_t i = 0; i < x.size() && x.size() > 1; ++i) out[i] = 0.5 * (i + 1 < x.size() ? x[i + 1] - x[i] : x[i] - x[i - 1]);
  return out;
}

/// x ± half as lo and hi.
void set_edges(const std::vector<double>& half, double share, Series& s) {
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    s.lo.push_back(s.x[i] - share * half[i]);
    s.hi.push_back(s.x[i] + share * half[i]);
  }
}

/// A round distance of marks that gives two or three of them up to `most`.
double round_step(double most) {
  if (!(most > 0.0)) return 0.0;
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double step : {0.2, 0.5, 1.0, 2.0, 5.0}) {
    if (most / (step * power) < 3.5) return step * power;
  }
  return power;
}

/// How a map is drawn among others.
struct MapLook {
  std::string key, legend, colour;
};

/// Grey where a map has no estimate although samples lie there: held out, or too few.
Series gaps_of(const ForceMap& map, double low, double high) {
  Series gaps{"no_estimate", "no estimate: held out, or too few samples", Style::band, grey, {}, {}, {}, {}};
  const std::vector<double> x = display_levels(map.x, map.quantity_unit), half = half_steps(x);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (map.sigma[i] > 0.0) continue;
    gaps.x.insert(gaps.x.end(), {x[i] - half[i], x[i] + half[i], no_point});
    gaps.lo.insert(gaps.lo.end(), {low, low, no_point});
    gaps.hi.insert(gaps.hi.end(), {high, high, no_point});
  }
  return gaps;
}

/// Amplitudes ± 1 sigma where there is an estimate.
void add_map(const ForceMap& map, const MapLook& look, Panel& panel) {
  const std::vector<double> x = display_levels(map.x, map.quantity_unit), sigma = display_values(map.sigma, map.port_unit);
  Series amplitude{
      look.key + "amplitude", look.legend, Style::error_bars, look.colour, x, display_values(map.amplitude, map.port_unit), {}, {}};
  double low = 0.0, high = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(sigma[i] > 0.0)) amplitude.y[i] = no_point;
    amplitude.lo.push_back(amplitude.y[i] - sigma[i]);
    amplitude.hi.push_back(amplitude.y[i] + sigma[i]);
    if (sigma[i] > 0.0) low = std::min(low, amplitude.lo[i]), high = std::max(high, amplitude.hi[i]);
  }
  Series gaps = gaps_of(map, low, high);
  if (panel.series.empty() && !gaps.x.empty()) panel.series.push_back(std::move(gaps));
  panel.series.push_back({look.key + "line", "", Style::line, look.colour, x, amplitude.y, {}, {}, 1.2});
  panel.series.push_back(std::move(amplitude));
}

/// The axes of a map, and how many samples each place has.
Figure figure_of_map(const ForceMap& map) {
  Figure figure;
  figure.x_label = map.quantity;
  figure.x_unit = display_level_unit(map.quantity_unit);
  Panel panel{.y_label = map.port, .y_unit = display_unit(map.port_unit), .height = 230.0, .zero_line = true};
  Panel counts{.y_label = "samples, weighted", .y_unit = "-", .height = 80.0};
  const std::vector<double> x = display_levels(map.x, map.quantity_unit);
  Series samples{"samples", "", Style::boxes, grey, x, map.count, {}, {}};
  set_edges(half_steps(x), 0.9, samples);
  if (map.quantity == time_of_recording) {  // nothing was recorded before and after
    for (double& low : samples.lo) low = std::max(low, x.front());
    for (double& high : samples.hi) high = std::min(high, x.back());
  }
  for (const double count : map.count) counts.y_step = std::max(counts.y_step, round_step(count));
  counts.series = {samples};
  figure.panels = {panel, counts};
  return figure;
}

std::size_t quantity_index(const MissingForce& missing, const std::string& quantity) {
  const auto found = std::find(missing.quantities.begin(), missing.quantities.end(), quantity);
  return found - missing.quantities.begin();
}

/// First and past the last; all where there is no zoom.
std::pair<std::ptrdiff_t, std::ptrdiff_t> samples_within(const std::vector<double>& t, const std::optional<Interval>& zoom) {
  if (!zoom) return {0, std::ssize(t)};
  return {std::lower_bound(t.begin(), t.end(), zoom->from) - t.begin(), std::upper_bound(t.begin(), t.end(), zoom->to) - t.begin()};
}

}  // namespace

Figure map_figure(const ForceMap& map) {
  Figure figure = figure_of_map(map);
  figure.name = "map_" + as_key(map.port) + "_by_" + as_key(map.quantity);
  figure.title = fmt::format("Missing {} against {} ({})", map.port, map.quantity, p_equals(map.p_corrected));
  figure.caption =
      fmt::format("Estimated unmodelled {} as a function of {} (free parameters re-adjusted), ± 1 sigma. {}", map.port, map.quantity,
                  map.sentence.empty() ? "The map as a whole does not differ significantly from zero." : "Here " + map.sentence + ".");
  add_map(map, {"", "missing force, ± 1 sigma", palette(1)}, figure.panels.front());
  return figure;
}

bool maps_show_nothing(const Diagnosis& diagnosis) {
  constexpr double significant = 0.01;
  return diagnosis.maps.empty() || !(diagnosis.maps.front().p_corrected < significant);
}

Figure map_change_figure(const ForceMap& before, const ForceMap& after, const std::string& added) {
  Figure figure = figure_of_map(before);
  figure.name = "missing_force_before_and_after";
  figure.title = fmt::format("Missing {} against {}, before and after", before.port, before.quantity);
  figure.caption =
      fmt::format("The force that the model lacks at each {}, ± 1 sigma: before, and with {} in it. At zero nothing is missing.",
                  before.quantity, added);
  add_map(before, {"before_", fmt::format("before ({})", p_equals(before.p_corrected)), palette(1)}, figure.panels.front());
  add_map(after, {"after_", fmt::format("with {} ({})", added, p_equals(after.p_corrected)), palette(0)}, figure.panels.front());
  return figure;
}

Figure pair_figure(const PairMap& map) {
  Figure figure;
  figure.name = "map_" + as_key(map.port) + "_by_" + as_key(map.quantity_x) + "_and_" + as_key(map.quantity_y);
  figure.title = fmt::format("Missing {} against {} and {} ({})", map.port, map.quantity_x, map.quantity_y, p_equals(map.p_corrected));
  figure.caption = "Estimated unmodelled force in units of its sigma: beyond 3 is unlikely by chance. Grey: too few samples.";
  figure.x_label = map.quantity_x;
  figure.x_unit = display_level_unit(map.unit_x);
  figure.z_label = "force over its sigma";
  figure.z_unit = std::string("-");
  Panel panel{.y_label = map.quantity_y, .y_unit = display_level_unit(map.unit_y), .height = 380.0};
  Series cells{"force", "", Style::cells, black, {}, {}, {}, {}};
  const std::vector<double> x = display_levels(map.x, map.unit_x), y = display_levels(map.y, map.unit_y);
  const std::vector<double> half_x = half_steps(x), half_y = half_steps(y);
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < y.size(); ++j) {
      const std::size_t at = i * y.size() + j;
      if (!(map.sigma[at] > 0.0)) continue;
      cells.x.push_back(x[i]);
      cells.y.push_back(y[j]);
      cells.lo.push_back(half_x[i]);
      cells.hi.push_back(half_y[j]);
      cells.z.push_back(map.amplitude[at] / map.sigma[at]);
    }
  }
  if (!y.empty()) panel.y_range = {y.front() - half_y.front(), y.back() + half_y.back()};
  panel.series = {cells};
  panel.ground = "#dcdcdc";
  figure.panels = {panel};
  return figure;
}

Figure innovation_figure(const std::vector<WhitenessReport>& whiteness) {
  Figure figure;
  figure.name = "innovations_autocorrelation";
  figure.title = "Innovations: autocorrelation";
  figure.caption = "For a correct model they are independent: 95 % of the lags stay inside the band.";
  figure.x_label = "lag";
  figure.x_unit = "samples";
  for (const WhitenessReport& w : whiteness) {
    Panel panel{.y_label = w.channel, .y_unit = "-", .height = 150.0, .zero_line = true};
    const std::string key = as_key(w.experiment + "_" + w.channel);
    Series rho{
        key, fmt::format("{} of {}, Ljung-Box {}", w.channel, w.experiment, p_equals(w.ljung_box_p)), Style::boxes, palette(0), {}, {}, {},
        {}};
    for (std::size_t lag = 1; lag < w.autocorrelation.size(); ++lag) {
      rho.x.push_back(static_cast<double>(lag));
      rho.y.push_back(w.autocorrelation[lag]);
    }
    set_edges(std::vector<double>(rho.x.size(), 0.5), 0.7, rho);
    if (!rho.x.empty()) {
      const std::string legend = figure.panels.empty() ? "95 % band of white innovations" : "";
      panel.series.push_back(
          {key + "_band", legend, Style::band, grey, {0.0, rho.x.back() + 1.0}, {}, {-w.band, -w.band}, {w.band, w.band}});
    }
    panel.series.push_back(std::move(rho));
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

Figure periodogram_figure(const std::vector<WhitenessReport>& whiteness) {
  Figure figure;
  figure.name = "innovations_periodogram";
  figure.title = "Innovations: cumulative periodogram";
  figure.caption =
      "The share of the variance below each frequency. White innovations follow the diagonal inside the band (Kolmogorov–Smirnov, 95 %); a "
      "jump indicates a spectral line, a smooth departure coloured innovations.";
  figure.x_label = "frequency";
  figure.x_unit = "Hz";
  Panel panel{.y_label = "cumulative power", .y_unit = "-", .y_range = std::array<double, 2>{0.0, 1.0}, .y_step = 0.25, .height = 320.0};
  std::set<std::pair<std::size_t, double>> bands;
  for (std::size_t k = 0; k < whiteness.size(); ++k) {
    const WhitenessReport& w = whiteness[k];
    if (w.frequency.empty()) continue;
    const std::pair of_band{w.frequency.size(), w.frequency.back()};  // how many innovations, how often
    if (bands.insert(of_band).second) {
      const double half = 1.36 / std::sqrt(static_cast<double>(of_band.first));
      const bool first = bands.size() == 1;
      panel.series.push_back({first ? "white" : fmt::format("white_{}", bands.size()),
                              first ? "band of white innovations" : "",
                              Style::band,
                              grey,
                              {0.0, of_band.second},
                              {},
                              {-half, 1.0 - half},
                              {half, 1.0 + half}});
    }
    double total = 0.0, sum = 0.0;
    for (const double p : w.power) total += std::isfinite(p) ? p : 0.0;
    Series s{as_key(w.experiment + "_" + w.channel),
             fmt::format("{} of {}, {}", w.channel, w.experiment, p_equals(w.periodogram_p)),
             Style::line,
             palette(k),
             w.frequency,
             {},
             {},
             {}};
    for (const double p : w.power) s.y.push_back((sum += std::isfinite(p) ? p : 0.0) / total);
    panel.series.push_back(std::move(s));
  }
  figure.panels = {panel};
  return figure;
}

Figure nis_figure(const NisSeries& series) {
  Figure figure;
  figure.name = "nis_" + file_name_for(series.experiment);
  figure.title = fmt::format("Normalised innovations squared, {}", series.experiment);
  figure.caption = fmt::format(
      "Innovations over their predicted sigma, squared and averaged over windows: 1 for a correct model, inside the band in 95 % of the "
      "windows. {:.1f} % lie outside.",
      100.0 * series.outside);
  figure.x_label = "time";
  figure.x_unit = std::string("s");
  Panel panel{.y_label = "NIS", .y_unit = "-", .height = 220.0};
  if (!series.t.empty()) {
    const std::vector<double> ends = {series.t.front(), series.t.back()};
    panel.series.push_back(
        {"band", "95 % band of a correct model", Style::band, grey, ends, {}, {series.lower, series.lower}, {series.upper, series.upper}});
  }
  panel.series.push_back({"nis", "mean over a window", Style::line, palette(0), series.t, series.nis, {}, {}, 1.4});
  figure.panels = {panel};
  return figure;
}

Figure missing_force_figure(const MissingForce& missing, const std::optional<Interval>& zoom) {
  Figure figure;
  figure.name = "missing_force_" + file_name_for(missing.experiment) + (zoom ? "_zoom" : "");
  figure.title = fmt::format("Missing force over time, {}{}", missing.experiment, zoom ? " (part)" : "");
  figure.caption =
      "Smoothed random force (from all data), ± 1 sigma. Correlation with the motion is expected even for a correct model: the force "
      "causes the motion.";
  figure.x_label = "time";
  figure.x_unit = std::string("s");
  const auto [from, to] = samples_within(missing.t, zoom);
  const auto cut = [from = from, to = to](const std::vector<double>& v) { return std::vector<double>(v.begin() + from, v.begin() + to); };
  const std::vector<double> t = cut(missing.t);
  for (std::size_t p = 0; p < missing.ports.size(); ++p) {
    const std::string key = as_key(missing.ports[p]);
    Panel panel{.y_label = missing.ports[p], .y_unit = display_unit(missing.port_units[p]), .height = 180.0, .zero_line = true};
    const std::vector<double> y = display_values(cut(missing.force[p]), missing.port_units[p]);
    const std::vector<double> sigma = display_values(cut(missing.sigma[p]), missing.port_units[p]);
    Series band{key + "_band", "", Style::band, palette(p), t, {}, {}, {}};
    for (std::size_t i = 0; i < y.size(); ++i) {
      band.lo.push_back(y[i] - sigma[i]);
      band.hi.push_back(y[i] + sigma[i]);
    }
    panel.series = {band, {key, missing.ports[p] + ", ± 1 sigma", Style::line, palette(p), t, y, {}, {}, 1.2}};
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

Figure added_force_figure(const MissingForce& missing, const Candidate& candidate, const std::optional<Interval>& zoom) {
  Figure figure = missing_force_figure(missing, zoom);
  const std::string effect = effect_at(candidate.effect, candidate.roles);
  figure.name = "added_" + figure.name;
  figure.title = fmt::format("Force that {} adds, beside the missing one, {}{}", effect, missing.experiment, zoom ? " (part)" : "");
  figure.caption = fmt::format(
      "Black: what {} adds to the model where it is fitted with it, at the smoothed motion. Coloured: the smoothed random force of the "
      "model without it, ± 1 sigma. The two are alike where nothing else is missing and no other parameter has made up for it; what "
      "drives the motion at random, such as turbulence, is in the coloured one, too.",
      effect);
  for (const AddedForce& added : candidate.added) {
    if (added.experiment != missing.experiment) continue;
    const auto [from, to] = samples_within(added.t, zoom);
    const auto cut = [from = from, to = to](const std::vector<double>& v) { return std::vector<double>(v.begin() + from, v.begin() + to); };
    for (std::size_t p = 0; p < added.ports.size(); ++p) {
      const auto port = std::find(missing.ports.begin(), missing.ports.end(), added.ports[p]);
      if (port == missing.ports.end()) continue;
      figure.panels[port - missing.ports.begin()].series.push_back({as_key(added.ports[p]) + "_added",
                                                                    effect,
                                                                    Style::line,
                                                                    black,
                                                                    cut(added.t),
                                                                    display_values(cut(added.force[p]), added.port_units[p]),
                                                                    {},
                                                                    {},
                                                                    1.2});
    }
  }
  return figure;
}

Figure missing_force_by_figure(const MissingForce& missing, const std::string& quantity) {
  Figure figure;
  figure.name = "missing_force_" + file_name_for(missing.experiment) + "_by_" + as_key(quantity);
  figure.title = fmt::format("Missing force against {}, {}", quantity, missing.experiment);
  figure.caption =
      "Every sample of the smoothed missing force. Correlation with the motion is expected even for a correct model: the maps above are "
      "the test.";
  const std::size_t q = quantity_index(missing, quantity);
  figure.x_label = quantity;
  const std::string unit = q < missing.quantities.size() ? missing.quantity_units[q] : "-";
  figure.x_unit = display_level_unit(unit);
  const std::vector<double> x =
      q < missing.quantities.size() ? display_levels(missing.values[q], unit) : std::vector<double>(missing.t.size(), no_point);
  for (std::size_t p = 0; p < missing.ports.size(); ++p) {
    Panel panel{.y_label = missing.ports[p], .y_unit = display_unit(missing.port_units[p]), .height = 200.0, .zero_line = true};
    panel.series = {
        {as_key(missing.ports[p]), "", Style::points, palette(p), x, display_values(missing.force[p], missing.port_units[p]), {}, {}}};
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

}  // namespace misfit::report
