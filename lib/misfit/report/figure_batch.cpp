#include "misfit/report/figure_batch.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/report/figure_units.h"

namespace misfit::report {
namespace {

/// Studies in the order of the rows: their place along x.
std::vector<std::string> studies_of(const Batch& batch) {
  std::vector<std::string> names;
  for (const BatchRow& row : batch.rows) {
    if (names.empty() || names.back() != row.study) names.push_back(row.study);
  }
  return names;
}

Panel panel_of(const Batch& batch, const BatchSummary& summary, const std::vector<std::string>& studies) {
  Panel panel;
  const std::string unit = display_unit(summary.unit);
  panel.height = 150.0;
  Series values{"value", "", Style::error_bars, palette(0), {}, {}, {}, {}};
  for (const BatchRow& row : batch.rows) {
    const auto found = row.values.find(summary.name);
    if (row.method != summary.method || found == row.values.end() || found->second.unit != summary.unit) continue;
    const auto place = std::find(studies.begin(), studies.end(), row.study) - studies.begin();
    const double value = display_value(found->second.value, summary.unit), sigma = display_value(found->second.sigma, summary.unit);
    values.x.push_back(static_cast<double>(place) + 1.0);
    values.y.push_back(value);
    values.lo.push_back(value - sigma);
    values.hi.push_back(value + sigma);
  }
  const double mean = display_value(summary.mean, summary.unit);
  const std::vector<double> ends{0.5, static_cast<double>(studies.size()) + 0.5};
  const std::string p = summary.p_value ? ", homogeneity: " + p_equals(*summary.p_value) : "";
  const std::string legend = summary.name + ": mean " + in_display_unit(summary.mean, summary.unit, summary.mean_sigma) + p;
  panel.series = {values, {"mean", legend, Style::dashed, grey, ends, {mean, mean}, {}, {}, 1.4}};
  return panel;
}

}  // namespace

Figure batch_figure(const Batch& batch, const std::string& method, std::size_t most) {
  Figure figure;
  figure.name = "batch_" + as_key(method);
  figure.title = "Results of all studies, " + method;
  figure.caption = "Value ± 1 sigma of each study, and the mean. A small p: the studies scatter by more than their sigmas explain.";
  const std::vector<std::string> studies = studies_of(batch);
  constexpr std::size_t max_labelled = 12;
  figure.x_label = studies.size() <= max_labelled ? "study" : "study, in the order of the list";
  for (std::size_t i = 0; i < studies.size() && studies.size() <= max_labelled; ++i)
    figure.x_marks.push_back({static_cast<double>(i) + 1.0, studies[i]});
  figure.x_range = {0.5, static_cast<double>(studies.size()) + 0.5};
  std::vector<const BatchSummary*> numbers;
  for (const BatchSummary& s : batch.summary) {
    if (s.method == method) numbers.push_back(&s);
  }
  std::stable_partition(numbers.begin(), numbers.end(), [](const BatchSummary* s) { return s->name == "trim"; });
  if (numbers.size() > most)
    figure.notes.push_back(counted(numbers.size() - most, "more number is", "more numbers are") + " in batch.csv.");
  for (std::size_t k = 0; k < std::min(most, numbers.size()); ++k) figure.panels.push_back(panel_of(batch, *numbers[k], studies));
  return figure;
}

std::vector<std::string> write_batch_figures(const std::filesystem::path& dir, const Batch& batch) {
  std::vector<std::string> methods;
  for (const BatchSummary& s : batch.summary) {
    if (std::find(methods.begin(), methods.end(), s.method) == methods.end()) methods.push_back(s.method);
  }
  std::vector<Figure> figures;
  for (const std::string& method : methods) figures.push_back(batch_figure(batch, method));
  static_cast<void>(write_figures(dir, figures));
  return files_of(figures);
}

}  // namespace misfit::report
