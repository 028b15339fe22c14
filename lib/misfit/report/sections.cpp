#include "misfit/report/sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "misfit/report/figures.h"
#include "misfit/report/figures_intervals.h"
#include "misfit/report/figures_simulated.h"
#include "misfit/report/figures_uncertainty.h"
#include "misfit/show/glossary.h"
#include "misfit/show/results.h"

namespace misfit::report {
namespace {

constexpr std::size_t samples_of_part = 300;

Interval whole_of(const std::vector<double>& t) { return t.empty() ? Interval{} : Interval{t.front(), t.back()}; }

constexpr std::string_view of_data = "data: ";  // begins the name of a fact of a fit (Fit::facts) that says what was done to an experiment

}  // namespace

void Draw::operator()(Figure figure) const {
  if (figure.name == first_) return;
  figure.name = page_.free_figure_name(figure.name);
  page_.figure(figure);
}

void Draw::first(const Figure& figure) {
  (*this)(figure);
  first_ = figure.name;
}

void curves_section(const ModelResults& model, const std::vector<Reference>& references, Page& page, const Draw& draw) {
  const std::vector<Fit>& fits = *model.fits;
  const auto names = curve_names(fits, references);
  Blocks differences;
  if (model.comparison != nullptr) differences.append(curve_difference_blocks(*model.comparison));
  if (names.empty()) return;
  const auto put = [&](const std::pair<std::string, std::string>& name) {
    Figure figure = curve_figure(name.first, name.second, fits, references);
    figure.name = model.subject.prefix + figure.name;
    draw(figure);
  };
  page.section("Curves" + model.subject.note);
  put(names.front());
  if (names.size() == 1 && differences.all().empty()) return;
  page.fold(names.size() > 1 ? "More curves, and where they differ" : "Where they differ");
  for (std::size_t k = 1; k < names.size(); ++k) put(names[k]);
  page.show(differences);
  page.unfold();
}

void uncertainty_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (!input.uncertainty) return;
  page.show(
      blocks_of(*input.uncertainty),
      [&](const std::string&) {
        for (const Figure& figure : uncertainty_figures(*input.uncertainty, input.references)) draw(figure);
      },
      of_study(input).note);
}

void resampling_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (!input.resampling) return;
  page.show(
      blocks_of(*input.resampling),
      [&](const std::string&) {
        for (const Figure& figure : interval_figures(*input.resampling)) draw(figure);
      },
      of_study(input).note);
}

void calibration_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (!input.calibration) return;
  page.show(blocks_of(*input.calibration), [&](const std::string&) {
    draw(calibration_figure(*input.calibration));
    draw(calibration_residual_figure(*input.calibration));
  });
}

void measured_section(const ReportInput& input, Page& page, const Draw& draw) {
  const auto has_attitude = [](const ExperimentInput& e) { return e.attitude.has_value(); };
  if (std::none_of(input.experiments.begin(), input.experiments.end(), has_attitude)) return;
  page.section("Measured motion");
  for (const ExperimentInput& experiment : input.experiments) {
    if (!experiment.attitude) continue;
    const Attitude& a = *experiment.attitude;
    draw(orientation_figure(experiment.name, a, part_to_draw(a.t, a.theta_mean, samples_of_part).value_or(whole_of(a.t))));
    draw(history_figure(experiment.name, a));
    draw(path_figure(experiment.name, a));
    draw(histogram_figure(experiment.name, a));
  }
}

void prediction_section(const ModelResults& model, Page& page, const Draw& draw) {
  const auto predicts = [](const Fit& fit) { return !fit.predictions.empty(); };
  if (std::none_of(model.fits->begin(), model.fits->end(), predicts)) return;
  const auto put = [&](Figure figure) {
    figure.name = model.subject.prefix + figure.name;
    draw(figure);
  };
  page.section("Predicted motion and residuals" + model.subject.note);
  for (const Fit& fit : *model.fits) {
    for (const ChannelPrediction& channel : fit.predictions) {
      put(motion_figure(fit.method, channel, std::nullopt));
      if (const auto part = part_to_draw(channel.t, channel.measured, samples_of_part)) put(motion_figure(fit.method, channel, part));
      put(autocorrelation_figure(fit.method, channel));
      put(residual_histogram_figure(fit.method, channel));
    }
  }
}

void simulated_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (!input.comparison || !input.comparison->motion) return;
  const SimulatedMotion& motion = *input.comparison->motion;
  std::vector<std::string> experiments;
  for (const MotionSeries& s : motion.series) {
    if (std::find(experiments.begin(), experiments.end(), s.experiment) == experiments.end()) experiments.push_back(s.experiment);
  }
  page.show(
      blocks_of(motion),
      [&](const std::string&) {
        for (const std::string& experiment : experiments) {
          for (const char* group : {"distribution", "autocorrelation", "spectrum"}) {
            const Figure figure = simulated_figure(motion, experiment, group);
            if (!figure.panels.empty()) draw(figure);  // a recording may be too short for a statistic
          }
        }
      },
      of_study(input).note);
}

void notes_section(const ReportInput& input, Page& page) {
  std::vector<std::string> notes;
  const auto add = [&](const std::string& from, const std::vector<std::string>& words) {
    for (const std::string& note : words) {
      const std::string line = from.empty() ? note : from + ": " + note;
      if (std::find(notes.begin(), notes.end(), line) == notes.end()) notes.push_back(line);
    }
  };
  for (const ExperimentInput& experiment : input.experiments) {
    if (experiment.track) add(experiment.name, experiment.track->notes);
    if (experiment.attitude) add(experiment.name, experiment.attitude->notes);
  }
  for (const Fit& fit : input.fits) {
    for (const auto& [name, words] : fit.facts) {
      if (name.starts_with(of_data)) add(name.substr(of_data.size()), {words});
    }
  }
  if (input.calibration) add("calibration", input.calibration->notes);
  for (const Reference& reference : input.references) add("", reference.notes);
  Blocks out;
  out.heading("Data notes");
  if (notes.empty()) {
    out.paragraph(
        "No notes on the data. Measurements that a method rejected or left out are under Results (How the methods ended, and their "
        "warnings) and Parameters.");
  }
  out.list({notes});
  page.show(out);
}

void words_section(Page& page) {
  TableBlock words{columns("word|meaning")};
  for (const Glossary& glossary : {main_glossary(), further_glossary()}) {
    for (const auto& [word, meaning] : glossary) words.rows.push_back({word, as_sentence(meaning)});
  }
  Blocks out;
  out.heading("Words");
  out.table(std::move(words));
  page.show(out);
}

void provenance_section(const ReportInput& input, Page& page) {
  const RunFacts& run = input.run;
  TableBlock facts{columns("|"), {{"misfit", run.version}, {"commit", run.commit}, {"seed", std::to_string(run.seed)}}};
  if (!run.date.empty()) facts.rows.push_back({"date", run.date});
  if (!run.command.empty()) facts.rows.push_back({"command", run.command});
  TableBlock files{columns("file|hash (FNV-1a, 64 bit)")};
  for (const auto& [file, hash] : run.hashes) files.rows.push_back({file, hash});
  TableBlock stages{columns("stage|>time [s]")};
  for (const auto& [stage, seconds] : run.stages) stages.rows.push_back({stage, fmt::format("{:.2f}", seconds)});
  page.section("Provenance");
  for (const TableBlock& table : {facts, files, stages}) page.table(table, Texts::as_written);
}

}  // namespace misfit::report
