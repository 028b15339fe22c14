#include <fmt/format.h>

#include <algorithm>

#include "misfit/data/curve_coefficient.h"
#include "misfit/report/rows.h"
#include "misfit/report/sections.h"
#include "misfit/report/symbols.h"

namespace misfit::report {
namespace {

bool usable(const Fit& fit) { return fit.status == FitStatus::converged || fit.status == FitStatus::not_converged; }

const MethodSummary* summary_of(const ReportInput& input, const std::string& method) {
  if (!input.comparison) return nullptr;
  for (const MethodSummary& m : input.comparison->methods) {
    if (m.method == method) return &m;
  }
  return nullptr;
}

void add_rows(std::vector<Row>& rows, const std::string& before, const std::map<std::string, Estimate>& estimates,
              const std::string& after) {
  for (const auto& [name, estimate] : estimates) rows.emplace_back(before + name + after, estimate);
}

std::vector<Row> key_rows(const ReportInput& input, const Fit& fit) {
  std::vector<Row> rows;
  if (fit.trim) rows.emplace_back("trim", *fit.trim);
  if (const MethodSummary* m = summary_of(input, fit.method)) {
    add_rows(rows, "slope of ", m->slopes, " at the trim");
    add_rows(rows, "", m->at_trim, " at the trim");
  }
  add_rows(rows, "rms of ", fit.rms, "");
  add_rows(rows, "rms of ", fit.validation_rms, ", held out");
  if (fit.loglik) rows.emplace_back("log-likelihood", *fit.loglik, 0.0, "-");
  if (fit.validation_loglik) rows.emplace_back("log-likelihood, held out", *fit.validation_loglik, 0.0, "-");
  return rows;
}

std::vector<std::string> findings(const ReportInput& input) {
  std::vector<std::string> sentences;
  for (const Fit& fit : input.fits) {
    if (!usable(fit)) {
      sentences.push_back(fit.method + " gives no result: " + (fit.message.empty() ? to_string(fit.status) : fit.message) + ".");
    } else if (fit.trim) {
      sentences.push_back(fmt::format("{} finds the {} deg.", fit.method, "trim at " + Row("trim", *fit.trim).shown_number()));
    }
    if (fit.driven) sentences.push_back(fit.method + ": residuals are not white: an unmodelled input drives the motion.");
  }
  for (const Fit& fit : input.fits) {
    for (const CurveEstimate& curve : fit.curves) {
      if (usable(fit) && !curve.informative) {
        sentences.push_back(
            fmt::format("{} of {} is not informative{}.", curve.name, fit.method, curve.why.empty() ? "" : ": " + curve.why));
      }
    }
  }
  if (input.comparison) {
    for (const TrimDifference& d : input.comparison->trims) {
      if (d.reference) sentences.push_back(d.sentence + ".");
    }
  }
  for (std::string& sentence : sentences) {
    while (sentence.ends_with("..")) sentence.pop_back();
    if (sentence.starts_with("the ")) sentence.front() = 'T';
  }
  sentences.insert(sentences.end(), input.notes.begin(), input.notes.end());
  return sentences;
}

std::string status_html(const Fit& fit) {
  const char* tone = fit.status == FitStatus::converged ? "good" : "bad";
  std::string words = to_string(fit.status);
  std::replace(words.begin(), words.end(), '_', ' ');
  std::string html =
      fmt::format("<tr><th>{}</th><td class=\"status {}\">{}</td><td>{}", html_text(fit.method), tone, words, html_text(fit.message));
  if (!fit.warnings.empty()) html += "<ul class=\"warnings\">";
  for (const std::string& warning : fit.warnings) html += "<li>" + html_text(warning) + "</li>";
  if (!fit.warnings.empty()) html += "</ul>";
  return html + fmt::format("</td><td class=\"number\">{:.2f}</td><td class=\"number\">{}</td></tr>\n", fit.seconds, fit.linearisations);
}

}  // namespace

void summary_section(const ReportInput& input, Page& page) {
  page.section("Summary");
  if (!input.question.empty()) page.paragraph(input.question, "question");
  page.subsection("What was found");
  page.list(findings(input));
  std::vector<Subject> subjects;
  for (const Fit& fit : input.fits) subjects.push_back({fit.method, key_rows(input, fit)});
  for (const Reference& reference : input.references) {
    if (reference.trim) subjects.push_back({reference.name + " (reference)", {Row("trim", *reference.trim)}});
  }
  if (!subjects.empty()) page.html(subjects_html(subjects));
  if (input.fits.empty()) return;
  page.subsection("Methods");
  page.html(
      "<div class=\"wide\"><table><thead><tr><th>method</th><th>status</th><th>termination and caveats</th>"
      "<th class=\"number\">time [s]</th><th class=\"number\">linearisations</th></tr></thead><tbody>\n");
  for (const Fit& fit : input.fits) page.html(status_html(fit));
  page.html("</tbody></table></div>\n");
}

void parameters_section(const ReportInput& input, Page& page) {
  if (input.fits.empty()) return;
  page.section("Parameters");
  page.paragraph(
      "Curve coefficients are in fit.json. ± is one standard deviation; a number without it was not estimated with an uncertainty.");
  for (const Fit& fit : input.fits) {
    std::vector<Row> rows;
    for (const auto& [name, estimate] : fit.parameters) {
      if (!is_curve_coefficient(name)) rows.emplace_back(name, estimate);
    }
    add_rows(rows, "noise: ", fit.noise, "");
    add_rows(rows, "force: ", fit.force, "");
    if (rows.empty() && fit.facts.empty()) continue;
    page.subsection(fit.method);
    if (!rows.empty()) page.html(rows_html(rows));
    std::vector<std::string> facts;
    for (const auto& [name, words] : fit.facts) facts.push_back(name + ": " + words);
    page.list(facts);
  }
}

}  // namespace misfit::report
