#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "misfit/core/display.h"
#include "misfit/core/file_name.h"
#include "misfit/core/lists.h"
#include "misfit/data/estimators.h"
#include "misfit/math/statistics.h"
#include "misfit/math/whiteness.h"
#include "misfit/report/extent.h"
#include "misfit/report/figure_units.h"
#include "misfit/report/figures.h"

namespace misfit::report {
namespace {

std::vector<double> masked(std::vector<double> values, const std::vector<bool>& keep) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!keep[i]) values[i] = no_point;
  }
  return values;
}

template <class V>
V slice(const V& values, std::ptrdiff_t from, std::ptrdiff_t to) {
  return V(values.begin() + from, values.begin() + to);
}

ChannelPrediction cut(const ChannelPrediction& c, const Interval& part) {
  const auto from = std::lower_bound(c.t.begin(), c.t.end(), part.from) - c.t.begin();
  const auto to = std::upper_bound(c.t.begin(), c.t.end(), part.to) - c.t.begin();
  return {c.experiment,
          c.channel,
          c.unit,
          slice(c.t, from, to),
          slice(c.measured, from, to),
          slice(c.predicted, from, to),
          slice(c.sigma, from, to),
          slice(c.held_out, from, to)};
}

std::vector<double> residuals(const ChannelPrediction& c) {
  std::vector<double> r(c.t.size());
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = c.measured[i] - c.predicted[i];
  return r;
}

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

/// Residuals over their sigma, NaN where held out or missing.
std::vector<double> normalised_residuals(const ChannelPrediction& c) {
  std::vector<double> r = residuals(c);
  for (std::size_t i = 0; i < r.size(); ++i) {
    if (std::isfinite(c.sigma[i]) && c.sigma[i] > 0.0) r[i] /= c.sigma[i];
    if (c.held_out[i]) r[i] = no_point;
  }
  return r;
}

/// What the line beside the measurements is: a prediction one sample ahead lies on them in every model.
const char* words_of_prediction(const std::string& method) {
  return method == random_force_estimator().name ? "predicted one sample ahead" : "predicted";
}

Panel motion_panel(const std::string& method, const ChannelPrediction& c) {
  Panel panel{.y_label = c.channel, .y_unit = display_level_unit(c.unit), .height = 270.0};
  std::vector<bool> estimation = c.held_out;
  estimation.flip();
  panel.series.push_back(
      {"measured", "measured", Style::points, black, c.t, masked(display_levels(c.measured, c.unit), estimation), {}, {}});
  panel.series.push_back({"predicted",
                          words_of_prediction(method),
                          Style::line,
                          palette(0),
                          c.t,
                          masked(display_levels(c.predicted, c.unit), estimation),
                          {},
                          {},
                          1.4});
  if (std::find(c.held_out.begin(), c.held_out.end(), true) != c.held_out.end()) {
    panel.series.push_back({"measured_held_out",
                            "measured, held out",
                            Style::points,
                            grey,
                            c.t,
                            masked(display_levels(c.measured, c.unit), c.held_out),
                            {},
                            {}});
    panel.series.push_back({"predicted_held_out",
                            "predicted, held out",
                            Style::line,
                            palette(1),
                            c.t,
                            masked(display_levels(c.predicted, c.unit), c.held_out),
                            {},
                            {},
                            1.4});
  }
  return panel;
}

/// Predictions that are nearly no prediction: before the states are known, behind gaps (fit/filter/settled.h).
std::size_t unsettled(const ChannelPrediction& c) {
  const double largest = largest_usual_sigma(c.sigma);
  return static_cast<std::size_t>(std::count_if(c.sigma.begin(), c.sigma.end(), [&](double v) { return v > largest; }));
}

/// What 99 % of the values are below; 0 of none.
double nearly_all_below(std::vector<double> values) {
  if (values.empty()) return 0.0;
  constexpr std::size_t hundred = 100;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>((hundred - 1) * (values.size() - 1) / hundred);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Of residuals and bands but for those, and but for single ones that are far beyond the others: on an axis that holds a spike nothing else
/// is seen. nullopt: it is that of all.
std::optional<std::array<double, 2>> range_of_residuals(const std::vector<double>& residual, const std::vector<double>& sigma) {
  const double largest = largest_usual_sigma(sigma);
  std::vector<double> residuals, bands;
  bool all = true;
  for (std::size_t k = 0; k < sigma.size(); ++k) {
    if (sigma[k] > largest) all = false;
    if (!(sigma[k] <= largest)) continue;
    bands.push_back(sigma[k]);
    if (std::isfinite(residual[k])) residuals.push_back(std::abs(residual[k]));
  }
  constexpr double margin = 1.05, spike = 3.0, room = 2.0;  // of normal ones the largest of 10 000 is 1.5 times what 99 % are below
  const double usual = std::max(nearly_all_below(residuals), nearly_all_below(bands));
  const double most = std::max(extent_of(residuals)[1], extent_of(bands)[1]);
  const bool spikes = most > spike * usual && usual > 0.0;
  const double extent = spikes ? room * usual : most;
  if ((all && !spikes) || !(extent > 0.0)) return std::nullopt;
  return std::array{-margin * extent, margin * extent};
}

/// "Residuals lie beyond the axis, the largest, 12.3 mm, at 61.2 s"; empty: none does. Not how many: the page draws long recordings by
/// their least and largest values only.
std::string beyond_axis(const ChannelPrediction& c, const Panel& panel) {
  if (!panel.y_range) return "";
  const std::vector<double> r = display_values(residuals(c), c.unit);
  std::optional<std::size_t> largest;
  for (std::size_t k = 0; k < r.size(); ++k) {
    if (std::abs(r[k]) > (largest ? std::abs(r[*largest]) : (*panel.y_range)[1])) largest = k;
  }
  if (!largest) return "";
  return fmt::format("Residuals lie beyond the axis, the largest, {}, at {:.6g} s",
                     with_display_unit(fmt::format("{:.3g}", r[*largest]), c.unit), c.t[*largest]);
}

Panel residual_panel(const ChannelPrediction& c) {
  const std::vector<double> sigma = display_values(c.sigma, c.unit);
  Panel panel{.y_label = "residual",
              .y_unit = display_unit(c.unit),
              .y_range = range_of_residuals(display_values(residuals(c), c.unit), sigma),
              .height = 130.0,
              .zero_line = true};
  panel.series.push_back({"sigma", "± 1 sigma of the prediction", Style::band, palette(0), c.t, {}, scaled(sigma, -1.0), sigma});
  panel.series.push_back({"residual", "measured − predicted", Style::points, black, c.t, display_values(residuals(c), c.unit), {}, {}});
  return panel;
}

constexpr double kHistogramEnd = 5.0;  // [sigma]

/// Share of the values per bin over its width; values beyond the ends count in the total.
Series density_boxes(const std::vector<double>& values) {
  constexpr int bins = 40;
  constexpr double width = 2.0 * kHistogramEnd / bins;
  Series s{"residual", "residuals / sigma", Style::boxes, palette(0), {}, std::vector<double>(bins, 0.0), {}, {}};
  const double each = 1.0 / (width * static_cast<double>(values.size()));
  for (const double v : values) {
    if (std::abs(v) < kHistogramEnd) s.y[static_cast<std::size_t>((v + kHistogramEnd) / width)] += each;
  }
  for (int k = 0; k < bins; ++k) {
    s.lo.push_back(-kHistogramEnd + width * k);
    s.hi.push_back(s.lo.back() + width);
    s.x.push_back(s.lo.back() + 0.5 * width);
  }
  return s;
}

Series standard_normal() {
  Series s{"normal", "standard normal distribution", Style::line, black, {}, {}, {}, {}, 1.4};
  for (double x = -kHistogramEnd; x <= kHistogramEnd + 1e-9; x += 0.1) {
    s.x.push_back(x);
    s.y.push_back(std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi));
  }
  return s;
}

}  // namespace

Interval typical_interval(const std::vector<double>& t, const std::vector<double>& values, double length) {
  if (t.empty()) return {0.0, length};
  const double span = t.back() - t.front();
  if (span <= length) return {t.front(), t.back()};
  Interval best;
  std::size_t most = 0;
  for (int k = 0; k <= 8; ++k) {
    const double from = t.front() + (span - length) * (1.0 / 3.0 + k / 24.0);
    std::size_t finite = 0;
    for (std::size_t i = 0; i < t.size(); ++i) finite += t[i] >= from && t[i] <= from + length && std::isfinite(values[i]) ? 1U : 0U;
    if (k == 0 || finite > most) {
      best = {from, from + length};
      most = finite;
    }
  }
  return best;
}

std::optional<Interval> part_to_draw(const std::vector<double>& t, const std::vector<double>& values, std::size_t samples) {
  constexpr std::ptrdiff_t fewest = 20;
  if (t.size() <= 2 * samples) return std::nullopt;
  const Interval out = typical_interval(t, values, static_cast<double>(samples) * usual_step(t));
  const auto within = std::upper_bound(t.begin(), t.end(), out.to) - std::lower_bound(t.begin(), t.end(), out.from);
  return within < fewest || within == std::ssize(t) ? std::nullopt : std::optional(out);
}

Figure motion_figure(const std::string& method, const ChannelPrediction& channel, const std::optional<Interval>& zoom) {
  const ChannelPrediction c = zoom ? cut(channel, *zoom) : channel;
  Figure figure;
  figure.name =
      "motion_" + as_key(method) + "_" + file_name_for(channel.experiment) + "_" + file_name_for(channel.channel) + (zoom ? "_zoom" : "");
  figure.title =
      fmt::format("{} of {}: measured and predicted by {}{}", channel.channel, channel.experiment, method, zoom ? " (part)" : "");
  figure.caption = fmt::format("{} against time: measured, and predicted by {}. Below: the residuals.", channel.channel, method);
  if (const std::size_t count = unsettled(c); count > 0)
    figure.caption += fmt::format(" {} of them, less certain than ten times the usual sigma, may lie beyond the axis.", count);
  figure.x_label = "time";
  figure.x_unit = std::string("s");  // g++ 12 warns wrongly about a one-letter literal assigned
  figure.panels = {motion_panel(method, c), residual_panel(c)};
  if (std::string beyond = beyond_axis(c, figure.panels.back()); !beyond.empty()) figure.notes.push_back(std::move(beyond));
  return figure;
}

Figure autocorrelation_figure(const std::string& method, const ChannelPrediction& channel, std::size_t max_lag) {
  const std::vector<double> r = normalised_residuals(channel);
  const std::vector<double> correlations = autocorrelation(r, static_cast<int>(max_lag));
  const auto count = static_cast<double>(count_finite(r));
  Figure figure;
  figure.name = "autocorrelation_" + as_key(method) + "_" + file_name_for(channel.experiment) + "_" + file_name_for(channel.channel);
  figure.title = fmt::format("Residuals of {} ({}, {}): autocorrelation", channel.channel, method, channel.experiment);
  figure.caption = "For a correct model the residuals are white: 95 % of the lags stay inside the band.";
  figure.x_label = "lag";
  figure.x_unit = "samples";
  Panel panel{.y_label = "autocorrelation", .y_unit = "-", .height = 220.0, .zero_line = true};
  Series rho{"residual", "residuals / sigma", Style::boxes, palette(0), {}, {}, {}, {}};
  for (std::size_t lag = 1; lag <= max_lag && static_cast<double>(lag) < count; ++lag) {
    const auto x = static_cast<double>(lag);
    rho.x.push_back(x);
    rho.y.push_back(correlations[lag]);
    rho.lo.push_back(x - 0.35);
    rho.hi.push_back(x + 0.35);
  }
  if (!rho.x.empty()) {
    const double limit = 1.96 / std::sqrt(count);
    panel.series.push_back(
        {"white", "95 % band of white residuals", Style::band, grey, {0.0, rho.x.back() + 1.0}, {}, {-limit, -limit}, {limit, limit}});
  }
  panel.series.push_back(std::move(rho));
  figure.panels.push_back(std::move(panel));
  return figure;
}

Figure residual_histogram_figure(const std::string& method, const ChannelPrediction& channel) {
  std::vector<double> r = normalised_residuals(channel);
  std::erase_if(r, [](double v) { return !std::isfinite(v); });
  const auto beyond = std::count_if(r.begin(), r.end(), [](double v) { return std::abs(v) >= kHistogramEnd; });
  Figure figure;
  figure.name = "residual_histogram_" + as_key(method) + "_" + file_name_for(channel.experiment) + "_" + file_name_for(channel.channel);
  figure.title = fmt::format("Residuals of {} ({}, {}): distribution", channel.channel, method, channel.experiment);
  figure.caption =
      "Density of the residuals over their predicted sigma (boxes) and of the standard normal distribution (line), which a correct model "
      "gives: heavy tails indicate outliers, another width a wrong sigma.";
  figure.x_label = "residual / sigma";
  figure.x_unit = std::string("-");
  Panel panel{.y_label = "density", .y_unit = "-", .height = 220.0};
  panel.series = {density_boxes(r), standard_normal()};
  figure.panels.push_back(std::move(panel));
  if (beyond > 0) figure.notes.push_back(fmt::format("{} of {} residuals are beyond ± {} sigma", beyond, r.size(), kHistogramEnd));
  return figure;
}

}  // namespace misfit::report
