#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/report/figures_discovery.h"

namespace misfit::report {

Figure candidates_figure(const std::vector<Candidate>& candidates, std::size_t most) {
  Figure figure;
  figure.name = "candidates";
  figure.title = "What the model could lack";
  figure.caption =
      "Drop = 2 (log-likelihood with the effect − without), each at its maximum. Predicted: by one step from the model as it is; actual: "
      "after fitting everything again. Larger explains more of the data.";
  figure.x_label = "drop";
  Panel panel;
  Series predicted{"predicted", "predicted drop", Style::bars, grey, {}, {}, {}, {}};
  Series actual{"actual", "actual drop", Style::bars, palette(0), {}, {}, {}, {}};
  Series accepted{"accepted", "actual drop, accepted", Style::bars, palette(2), {}, {}, {}, {}};
  const std::size_t count = std::min(most, candidates.size());
  constexpr double half = 0.18, apart = 0.2;
  const auto add = [](Series& series, double value, double y) {
    series.x.push_back(value);
    series.y.push_back(y);
    series.lo.push_back(y - half);
    series.hi.push_back(y + half);
  };
  for (std::size_t k = 0; k < count; ++k) {
    const Candidate& c = candidates[k];
    const auto place = static_cast<double>(count - k);
    panel.y_marks.push_back({place, c.effect});
    add(predicted, c.predicted_drop, place + apart);
    if (c.actual_drop) add(c.accepted ? accepted : actual, *c.actual_drop, place - apart);
  }
  panel.series = {predicted};
  for (const Series* series : {&actual, &accepted}) {
    if (!series->x.empty()) panel.series.push_back(*series);
  }
  panel.y_range = {0.4, static_cast<double>(count) + 0.6};
  panel.height = 40.0 + 34.0 * static_cast<double>(count);
  figure.panels = {panel};
  if (count < candidates.size()) figure.notes.push_back(fmt::format("{} more are in candidates.json.", candidates.size() - count));
  return figure;
}

}  // namespace misfit::report
