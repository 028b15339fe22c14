#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/text.h"
#include "misfit/report/figures_discovery.h"

namespace misfit::report {
namespace {

constexpr double threshold = 0.01;    // family-wise; what discover accepts by
constexpr double longest_bar = 20.0;  // −log10 p: beyond, bars end

void add_bar(Series& series, double value, double y, double half) {
  series.x.push_back(value);
  series.y.push_back(y);
  series.lo.push_back(y - half);
  series.hi.push_back(y + half);
}

double strength_of_evidence(double p) { return p > 0.0 ? std::clamp(0.0 - std::log10(p), 0.0, longest_bar) : longest_bar; }

Panel drop_panel(const std::vector<Candidate>& candidates, std::size_t count) {
  Panel panel;
  Series predicted{"predicted", "predicted drop", Style::bars, grey, {}, {}, {}, {}};
  Series actual{"actual", "actual drop", Style::bars, palette(0), {}, {}, {}, {}};
  Series accepted{"accepted", "actual drop, accepted", Style::bars, palette(2), {}, {}, {}, {}};
  constexpr double half = 0.18, apart = 0.2;
  for (std::size_t k = 0; k < count; ++k) {
    const Candidate& c = candidates[k];
    const auto place = static_cast<double>(count - k);
    panel.y_marks.push_back({place, effect_at(c.effect, c.roles)});
    add_bar(predicted, c.predicted_drop, place + apart, half);
    if (c.actual_drop) add_bar(c.accepted ? accepted : actual, *c.actual_drop, place - apart, half);
  }
  panel.series = {predicted};
  for (const Series* series : {&actual, &accepted}) {
    if (!series->x.empty()) panel.series.push_back(*series);
  }
  return panel;
}

/// −log10 p with the threshold: beside the drops, since a drop of many parameters or scanned shapes means less.
Panel evidence_panel(const std::vector<Candidate>& candidates, std::size_t count) {
  Panel panel;
  Series p{"minus_log10_p", "", Style::bars, palette(0), {}, {}, {}, {}};
  Series limit{"threshold", fmt::format("p = {:g}", threshold), Style::dashed, palette(1), {}, {}, {}, {}};
  constexpr double half = 0.3;
  for (std::size_t k = 0; k < count; ++k) add_bar(p, strength_of_evidence(candidates[k].p_value), static_cast<double>(count - k), half);
  limit.x = {-std::log10(threshold), -std::log10(threshold)};
  limit.y = {0.4, static_cast<double>(count) + 0.6};
  double most = 3.0;
  for (double v : p.x) most = std::max(most, v);
  panel.series = {p, limit};
  panel.beside = OwnX{"−log10 p", {0.0, 1.05 * most}};
  return panel;
}

}  // namespace

Figure candidates_figure(const std::vector<Candidate>& candidates, std::size_t most) {
  Figure figure;
  figure.name = "candidates";
  figure.title = "What could be missing";
  figure.caption =
      "Left, drop = 2 (log-likelihood with the effect − without), each at its maximum. Predicted: by one Gauss–Newton step; "
      "actual: after refitting all parameters. Right, p-value corrected for all families tested: only candidates beyond the dashed line "
      "can be accepted.";
  figure.x_label = "drop";
  const std::size_t count = std::min(most, candidates.size());
  figure.panels = {drop_panel(candidates, count), evidence_panel(candidates, count)};
  for (Panel& panel : figure.panels) {
    panel.y_range = {0.4, static_cast<double>(count) + 0.6};
    panel.height = 40.0 + 34.0 * static_cast<double>(count);
  }
  if (count < candidates.size()) figure.notes.push_back(counted(candidates.size() - count, "more is", "more are") + " in candidates.json.");
  const auto beyond = [](const Candidate& c) { return !(c.p_value > std::pow(10.0, -longest_bar)); };
  if (std::any_of(candidates.begin(), candidates.begin() + count, beyond))
    figure.notes.push_back(fmt::format("p below 1e-{:.0f} is drawn as 1e-{:.0f}.", longest_bar, longest_bar));
  return figure;
}

}  // namespace misfit::report
