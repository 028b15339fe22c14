#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/display.h"
#include "misfit/report/figures_discovery.h"
#include "misfit/report/sections.h"
#include "misfit/show/results.h"
#include "misfit/show/verdict.h"
#include "misfit/show/verdict_evidence.h"

namespace misfit::report {
namespace {

/// A method with a random force estimates what drives the motion; with the others the residuals show it.
std::string driven_sentence(const Fit& fit) {
  if (fit.force.empty()) return fit.method + ": residuals are not white: an unmodelled input drives the motion";
  return fit.method + ": the motion is driven by forces that the model does not describe, estimated as a random force (see Parameters)";
}

/// Why a method ended, without what follows a colon: its evidence is in the table of the methods.
std::string first_clause(const Fit& fit) {
  return fit.message.empty() ? to_string(fit.status) : fit.message.substr(0, fit.message.find(": "));
}

/// What the verdict does not say: methods without a result, references, and without a verdict the trims and what drives the motion.
std::vector<std::string> findings(const ModelResults& model, bool verdict) {
  std::vector<std::string> sentences;
  for (const Fit& fit : *model.fits) {
    if (!fit.usable()) sentences.push_back(fit.method + " gives no result: " + first_clause(fit));
    if (verdict) continue;
    if (fit.usable() && fit.trim)
      sentences.push_back(
          fmt::format("{} finds the trim at {}", fit.method, in_display_unit(fit.trim->value, fit.trim->unit, fit.trim->sigma)));
    if (fit.driven) sentences.push_back(driven_sentence(fit));
  }
  if (model.comparison != nullptr) {
    for (const TrimDifference& d : model.comparison->trims) {
      if (d.reference) sentences.push_back(d.sentence);
    }
  }
  return sentences;
}

/// That of the verdict, or where it has no predictions to draw, the last one that has.
const Fit* fit_to_draw(const std::vector<Fit>& fits) {
  const Fit* leading = leading_fit(fits);
  if (leading != nullptr && !leading->predictions.empty()) return leading;
  const auto last = std::find_if(fits.rbegin(), fits.rend(), [](const Fit& fit) { return !fit.predictions.empty(); });
  return last == fits.rend() ? nullptr : &*last;
}

/// Of the last model, where the verdict is that something of unknown form is missing and comes in pulses; nullptr: it is another.
const MissingForce* missing_in_pulses(const ReportInput& input) {
  const std::optional<Diagnosis>& last = input.rung ? input.rung->diagnosis : input.diagnosis;
  if (input.verdict->kind != VerdictKind::unknown_form || !last || !last->pulses) return nullptr;
  const std::string& experiment = last->pulses->front().experiment;
  const auto found =
      std::find_if(last->missing.begin(), last->missing.end(), [&](const MissingForce& m) { return m.experiment == experiment; });
  return found == last->missing.end() ? nullptr : &*found;
}

/// What is predicted far ahead, before and with what was added: of what acts late, or has a memory, a map of the missing force shows
/// nothing.
std::optional<Figure> picture_of_change_ahead(const ReportInput& input) {
  if (!input.last_model) return std::nullopt;
  const Fit* before = leading_fit(input.fits);
  const Fit* after = leading_fit(input.last_model->fits);
  if (before == nullptr || after == nullptr) return std::nullopt;
  return change_ahead_figure(*before, *after, input.last_model->added);
}

/// The picture in which one sees the verdict: the pulses of the missing force over time, the missing force before and after where it was
/// significant, else what is predicted far ahead before and after, or where a force is missing, or the camera's residuals, or the motion
/// that the model follows or does not.
std::optional<Figure> picture_of(const ReportInput& input) {
  const Verdict& verdict = *input.verdict;
  if (verdict.kind == VerdictKind::calibration && input.calibration && !input.calibration->residuals.empty())
    return calibration_residual_figure(*input.calibration);
  if (const MissingForce* pulses = missing_in_pulses(input)) return missing_force_figure(*pulses, std::nullopt);
  const bool maps = input.diagnosis && !input.diagnosis->maps.empty();
  if (!input.diagnosis || maps_show_nothing(*input.diagnosis)) {
    if (auto ahead = picture_of_change_ahead(input)) return ahead;
  }
  if (maps && input.rung && input.rung->diagnosis) {
    const ForceMap& before = input.diagnosis->maps.front();
    if (const ForceMap* after = find_map(*input.rung->diagnosis, before.port, before.quantity))
      return map_change_figure(before, *after, input.rung->added);
  }
  if (maps) return map_figure(input.diagnosis->maps.front());
  const Fit* fit = fit_to_draw(input.fits);
  return fit == nullptr ? std::nullopt : std::optional(motion_figure(fit->method, fit->predictions.front(), std::nullopt));
}

/// Without the underscores of a key; what follows a key of several words is the name of a curve, a channel, an experiment.
std::string fact_in_words(std::string name) {
  if (name.find(' ') == std::string::npos) std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

}  // namespace

void verdict_section(const ReportInput& input, Page& page, Draw& draw) {
  if (!input.verdict) return;
  page.show(blocks_of(*input.verdict));
  if (const auto picture = picture_of(input)) draw.first(*picture);
}

void summary_section(const ReportInput& input, const ModelResults& model, Page& page) {
  page.section("Results" + model.subject.note);
  Blocks results;
  if (model.comparison != nullptr) results.table(method_table(*model.comparison));
  page.show(results);
  std::vector<std::string> sentences = findings(model, input.verdict.has_value());
  if (model.fits == &input.fits) sentences.insert(sentences.end(), input.notes.begin(), input.notes.end());
  Blocks found;
  found.list({as_sentences(sentences)});
  page.show(found);
  if (model.fits->empty()) return;
  page.fold("How the methods ended, and their warnings");
  page.show(status_blocks(*model.fits));
  page.unfold();
}

void parameters_section(const ModelResults& model, Page& page) {
  if (model.fits->empty()) return;
  Blocks out;
  out.heading("Parameters");
  out.paragraph("± is one standard deviation. Coefficients of curves are in fit.json.");
  for (const Fit& fit : *model.fits) {
    TableBlock parameters = parameter_table(fit);
    if (parameters.rows.empty() && fit.facts.empty()) continue;
    out.subheading(fit.method);
    out.table(std::move(parameters));
    std::vector<std::string> facts;
    for (const auto& [name, words] : fit.facts) facts.push_back(fact_in_words(name) + ": " + words);
    out.list({facts});
  }
  page.show(out, {}, model.subject.note);
}

}  // namespace misfit::report
