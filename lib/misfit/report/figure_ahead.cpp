#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/units.h"
#include "misfit/report/figures.h"

namespace misfit::report {
namespace {

/// A channel as two models predict it.
struct Compared {
  const ChannelPrediction *before, *after;
};

bool has_predictions_ahead(const ChannelPrediction& c) { return c.ahead.size() == c.t.size() && !c.t.empty(); }

/// Squares of the errors far ahead where both models predict; NaN elsewhere.
struct SquaredErrors {
  std::vector<double> before, after;
};

SquaredErrors squared_errors(const Compared& c) {
  SquaredErrors out;
  for (std::size_t k = 0; k < c.before->t.size(); ++k) {
    const double before = std::pow(c.before->measured[k] - c.before->ahead[k], 2),
                 after = std::pow(c.after->measured[k] - c.after->ahead[k], 2);
    const bool both = std::isfinite(before) && std::isfinite(after);
    out.before.push_back(both ? before : no_point);
    out.after.push_back(both ? after : no_point);
  }
  return out;
}

double sum_of_finite(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += std::isfinite(v) ? v : 0.0;
  return sum;
}

/// The channels that both have, of the same samples.
std::vector<Compared> compared_channels(const Fit& before, const Fit& after) {
  std::vector<Compared> out;
  for (const ChannelPrediction& b : before.predictions) {
    for (const ChannelPrediction& a : after.predictions) {
      const bool same = a.experiment == b.experiment && a.channel == b.channel && a.unit == b.unit && a.t == b.t;
      if (same && has_predictions_ahead(a) && has_predictions_ahead(b)) out.push_back({&b, &a});
    }
  }
  return out;
}

/// First and past the last of so many samples in which the errors fall most.
std::pair<std::size_t, std::size_t> where_errors_fall(const SquaredErrors& errors, std::size_t length) {
  const std::size_t samples = errors.before.size();
  if (samples <= length) return {0, samples};
  const auto fall = [&](std::size_t k) { return std::isfinite(errors.before[k]) ? errors.before[k] - errors.after[k] : 0.0; };
  double sum = 0.0;
  for (std::size_t k = 0; k < length; ++k) sum += fall(k);
  double most = sum;
  std::size_t first = 0;
  for (std::size_t k = length; k < samples; ++k) {
    sum += fall(k) - fall(k - length);
    if (sum > most) most = sum, first = k + 1 - length;
  }
  return {first, first + length};
}

/// The finite values of samples first … last − 1; a gap between them that is longer than the usual one breaks the line.
Series line_through(std::string key, std::string legend, std::string colour, const ChannelPrediction& c,
                    std::pair<std::size_t, std::size_t> part) {
  Series out{std::move(key), std::move(legend), Style::line, std::move(colour), {}, {}, {}, {}, 1.6};
  const std::vector<double> levels = display_levels(c.ahead, c.unit);
  std::size_t usual = c.t.size(), last = part.first;
  for (std::size_t k = part.first; k < part.second; ++k) {
    if (!std::isfinite(levels[k])) continue;
    if (!out.x.empty()) usual = std::min(usual, k - last);
    if (!out.x.empty() && k - last > usual) {
      out.x.push_back(c.t[k]);
      out.y.push_back(no_point);
    }
    out.x.push_back(c.t[k]);
    out.y.push_back(levels[k]);
    last = k;
  }
  return out;
}

Series measured_points(const ChannelPrediction& c, std::pair<std::size_t, std::size_t> part) {
  const std::vector<double> levels = display_levels(c.measured, c.unit);
  const auto of = [&](const std::vector<double>& values) {
    return std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(part.first),
                               values.begin() + static_cast<std::ptrdiff_t>(part.second));
  };
  return {"measured", "measured", Style::points, black, of(c.t), of(levels), {}, {}};
}

}  // namespace

std::optional<Figure> change_ahead_figure(const Fit& before, const Fit& after, const std::string& added) {
  constexpr std::size_t shown = 400;  // samples: fewer hide how often it happens, more how
  const std::vector<Compared> channels = compared_channels(before, after);
  const Compared* most = nullptr;
  double least_ratio = 0.8;  // of the squares: a smaller fall is not seen
  for (const Compared& c : channels) {
    const SquaredErrors errors = squared_errors(c);
    const double ratio = sum_of_finite(errors.after) / sum_of_finite(errors.before);
    if (ratio < least_ratio) most = &c, least_ratio = ratio;
  }
  if (most == nullptr) return std::nullopt;
  const ChannelPrediction& c = *most->before;
  const auto part = where_errors_fall(squared_errors(*most), shown);
  const bool whole = part.second - part.first == c.t.size();
  Figure figure;
  figure.name = "predicted_before_and_after";
  figure.title = fmt::format("{} of {}, {} samples ahead, before and after", c.channel, c.experiment, kFarAhead);
  figure.caption =
      fmt::format("{} as measured, and as predicted from what was known {} samples earlier: before, and with {} in the model.{}", c.channel,
                  kFarAhead, added, whole ? "" : " The part of the recording in which the errors fall most.");
  figure.x_label = "time";
  figure.x_unit = std::string("s");
  Panel panel{.y_label = c.channel, .y_unit = display_level_unit(c.unit), .height = 300.0};
  panel.series = {measured_points(c, part), line_through("before", "before", palette(1), c, part),
                  line_through("after", "with " + added, palette(0), *most->after, part)};
  figure.panels = {std::move(panel)};
  return figure;
}

}  // namespace misfit::report
