#include "misfit/report/sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "misfit/core/files.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/report/figures.h"
#include "misfit/report/figures_simulated.h"
#include "misfit/report/rows.h"

namespace misfit::report {
namespace {

constexpr double zoom_seconds = 5.0;

std::vector<std::pair<std::string, std::string>> curves_of(const ReportInput& input) {
  std::vector<std::pair<std::string, std::string>> names;
  const auto add = [&](const std::string& curve, const std::string& of) {
    if (std::find(names.begin(), names.end(), std::pair(curve, of)) == names.end()) names.emplace_back(curve, of);
  };
  for (const Fit& fit : input.fits) {
    for (const CurveEstimate& curve : fit.curves) add(curve.name, curve.of);
  }
  for (const Reference& reference : input.references) add(reference.curve, reference.of);
  return names;
}

void differences_table(const Comparison& comparison, Page& page) {
  std::vector<std::vector<std::string>> rows = {
      {"curve", "between", "rms [sigma]", "largest [sigma]", "at", "difference there", "compared from", "to"}};
  for (const CurveDifference& d : comparison.curves) {
    const std::string unit = display_unit(d.of_unit);
    const auto x = [&](double value) { return fmt::format("{:.3g} {}", convert(value, d.of_unit, unit), unit); };
    const Row there("difference", d.difference.value, d.difference.sigma, d.unit.empty() ? "-" : d.unit);
    rows.push_back({d.curve, d.a + " − " + d.b, fmt::format("{:.2f}", d.rms_sigmas), fmt::format("{:.2f}", d.max_sigmas), x(d.at),
                    there.shown_number() + " " + there.shown_unit(), x(d.from), x(d.to)});
  }
  if (rows.size() > 1) page.subsection("Differences between curves");
  page.table(rows);
}

}  // namespace

void Draw::operator()(Figure figure) const {
  figure.name = page_.free_figure_name(figure.name);
  page_.figure(figure, read_file(write_figure(folder_, figure)));
}

void curves_section(const ReportInput& input, Page& page, const Draw& draw) {
  const auto names = curves_of(input);
  if (names.empty() && !input.comparison) return;
  page.section("Curves");
  for (const auto& [curve, of] : names) draw(curve_figure(curve, of, input.fits, input.references));
  if (!input.comparison) return;
  differences_table(*input.comparison, page);
  std::vector<std::string> left_out;
  for (const NotCompared& n : input.comparison->not_compared) left_out.push_back(n.what + " (" + n.why + ")");
  if (!left_out.empty()) page.subsection("Not compared");
  page.list(left_out);
}

void measured_section(const ReportInput& input, Page& page, const Draw& draw) {
  const auto has_attitude = [](const ExperimentInput& e) { return e.attitude.has_value(); };
  if (std::none_of(input.experiments.begin(), input.experiments.end(), has_attitude)) return;
  page.section("Measured motion");
  for (const ExperimentInput& experiment : input.experiments) {
    if (!experiment.attitude) continue;
    const Attitude& a = *experiment.attitude;
    draw(orientation_figure(experiment.name, a, typical_interval(a.t, a.theta_mean, zoom_seconds)));
    draw(history_figure(experiment.name, a));
    draw(path_figure(experiment.name, a));
    draw(histogram_figure(experiment.name, a));
  }
}

void prediction_section(const ReportInput& input, Page& page, const Draw& draw) {
  const auto predicts = [](const Fit& fit) { return !fit.predictions.empty(); };
  if (std::none_of(input.fits.begin(), input.fits.end(), predicts)) return;
  page.section("Predicted motion and residuals");
  for (const Fit& fit : input.fits) {
    for (const ChannelPrediction& channel : fit.predictions) {
      const Interval zoom = typical_interval(channel.t, channel.measured, zoom_seconds);
      draw(motion_figure(fit.method, channel, std::nullopt));
      if (!channel.t.empty() && channel.t.back() - channel.t.front() > 2.0 * zoom_seconds) draw(motion_figure(fit.method, channel, zoom));
      draw(autocorrelation_figure(fit.method, channel));
    }
  }
}

void simulated_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (!input.comparison || !input.comparison->motion) return;
  const SimulatedMotion& motion = *input.comparison->motion;
  page.section("Simulated against measured motion");
  page.paragraph(
      "Random motion cannot be matched sample by sample: a correct model must reproduce its statistics. Small p: the fitted model does "
      "not reproduce that group of statistics.");
  page.list(motion.sentences);
  page.list(motion.notes);
  std::vector<std::string> experiments;
  for (const MotionSeries& s : motion.series) {
    if (std::find(experiments.begin(), experiments.end(), s.experiment) == experiments.end()) experiments.push_back(s.experiment);
  }
  for (const std::string& experiment : experiments) {
    for (const char* group : {"distribution", "autocorrelation", "spectrum"}) draw(simulated_figure(motion, experiment, group));
  }
  std::vector<std::vector<std::string>> rows = {{"experiment", "series", "statistics", "p", "outside their band"}};
  for (const MotionSeries& s : motion.series) {
    for (const MotionGroup& g : s.groups) {
      const auto outside = std::count_if(g.numbers.begin(), g.numbers.end(), [](const MotionNumber& n) { return n.outside; });
      rows.push_back({s.experiment, s.name, g.name, fmt::format("{:.3f}", g.p_value), fmt::format("{} of {}", outside, g.numbers.size())});
    }
  }
  page.table(rows);
}

void notes_section(const ReportInput& input, Page& page) {
  std::vector<std::string> notes;
  const auto add = [&](const std::string& from, const std::vector<std::string>& words) {
    for (const std::string& note : words) notes.push_back(from.empty() ? note : from + ": " + note);
  };
  for (const ExperimentInput& experiment : input.experiments) {
    if (experiment.track) add(experiment.name, experiment.track->notes);
    if (experiment.attitude) add(experiment.name, experiment.attitude->notes);
  }
  if (input.calibration) add("calibration", input.calibration->notes);
  for (const Reference& reference : input.references) add("", reference.notes);
  page.section("Data notes");
  if (notes.empty()) page.paragraph("No sample was dropped or rejected.");
  page.list(notes);
}

void provenance_section(const ReportInput& input, Page& page) {
  page.section("Provenance");
  std::vector<std::vector<std::string>> facts = {{"", ""}, {"misfit", input.run.version}, {"commit", input.run.commit}};
  facts.push_back({"seed", std::to_string(input.run.seed)});
  if (!input.run.command.empty()) facts.push_back({"command", input.run.command});
  page.table(facts);
  std::vector<std::vector<std::string>> files = {{"file", "hash (FNV-1a, 64 bit)"}};
  for (const auto& [file, hash] : input.run.hashes) files.push_back({file, hash});
  page.table(files);
  std::vector<std::vector<std::string>> stages = {{"stage", "time [s]"}};
  for (const auto& [stage, seconds] : input.run.stages) stages.push_back({stage, fmt::format("{:.2f}", seconds)});
  page.table(stages);
}

}  // namespace misfit::report
