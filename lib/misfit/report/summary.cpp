#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/display.h"
#include "misfit/report/sections.h"
#include "misfit/show/results.h"

namespace misfit::report {
namespace {

/// A method with a random force estimates what drives the motion; with the others the residuals show it.
std::string driven_sentence(const Fit& fit) {
  if (fit.force.empty()) return fit.method + ": residuals are not white: an unmodelled input drives the motion";
  return fit.method + ": the motion is driven by forces that the model does not describe, estimated as a random force (see Parameters)";
}

std::vector<std::string> findings(const ReportInput& input) {
  std::vector<std::string> sentences;
  for (const Fit& fit : input.fits) {
    if (!fit.usable()) {
      sentences.push_back(fit.method + " gives no result: " + (fit.message.empty() ? to_string(fit.status) : fit.message));
    } else if (fit.trim) {
      sentences.push_back(
          fmt::format("{} finds the trim at {}", fit.method, in_display_unit(fit.trim->value, fit.trim->unit, fit.trim->sigma)));
    }
    if (fit.driven) sentences.push_back(driven_sentence(fit));
  }
  for (const Fit& fit : input.fits) {
    for (const CurveEstimate& curve : fit.curves) {
      if (fit.usable() && !curve.informative) {
        sentences.push_back(
            fmt::format("curve {} of {} is not informative{}", curve.name, fit.method, curve.why.empty() ? "" : ": " + curve.why));
      }
    }
  }
  if (input.comparison) {
    for (const TrimDifference& d : input.comparison->trims) {
      if (d.reference) sentences.push_back(d.sentence);
    }
  }
  sentences.insert(sentences.end(), input.notes.begin(), input.notes.end());
  return as_sentences(sentences);
}

}  // namespace

void summary_section(const ReportInput& input, Page& page) {
  Blocks out;
  out.heading("Summary");
  out.paragraph(input.question, Tone::lead);
  out.subheading("Findings");
  out.list({findings(input)});
  if (input.comparison) out.table(method_table(*input.comparison));
  if (!input.fits.empty()) out.subheading("Methods");
  out.append(status_blocks(input.fits));
  page.show(out);
}

void parameters_section(const ReportInput& input, Page& page) {
  if (input.fits.empty()) return;
  Blocks out;
  out.heading("Parameters");
  out.paragraph("± is one standard deviation. Coefficients of curves are in fit.json.");
  for (const Fit& fit : input.fits) {
    TableBlock parameters = parameter_table(fit);
    if (parameters.rows.empty() && fit.facts.empty()) continue;
    out.subheading(fit.method);
    out.table(std::move(parameters));
    std::vector<std::string> facts;
    for (const auto& [name, words] : fit.facts) facts.push_back(name + ": " + words);
    out.list({facts});
  }
  page.show(out);
}

}  // namespace misfit::report
