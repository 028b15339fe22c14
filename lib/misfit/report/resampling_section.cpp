#include <fmt/format.h>
#include <fmt/ranges.h>

#include "misfit/core/display.h"
#include "misfit/report/figures_intervals.h"
#include "misfit/report/rows.h"
#include "misfit/report/sections.h"

namespace misfit::report {
namespace {

using Cells = std::vector<std::vector<std::string>>;

/// The end of an interval, to a tenth of the sigma; it has no sigma of its own.
std::string end_at(double value, double sigma, const std::string& unit) {
  constexpr double fine = 0.1;
  const Row row("", value, fine * sigma, unit);
  const std::string number = row.shown_number();
  return number.substr(0, number.find(" ±")) + (row.shown_unit() == "-" ? "" : " " + row.shown_unit());
}

std::string end_of(bool found, double value, double sigma, const std::string& unit) {
  return found ? end_at(value, sigma, unit) : "not reached";
}

void bootstraps(const Resampling& r, Page& page) {
  if (r.bootstraps.empty()) return;
  Cells rows{{"block bootstrap of", "number", "fit ± its sigma", "mean ± sigma of the runs", "2.5 %", "97.5 %", "runs"}};
  std::vector<std::string> words;
  for (const Bootstrap& b : r.bootstraps) {
    for (const BootstrapNumber& n : b.numbers) {
      rows.push_back({b.method, n.name, in_display_unit(n.value, n.unit, n.fit_sigma), in_display_unit(n.mean, n.unit, n.sigma),
                      end_at(n.lower, n.sigma, n.unit), end_at(n.upper, n.sigma, n.unit), std::to_string(n.runs)});
    }
    words.push_back(fmt::format("{}: {} runs of {}, blocks of {} samples; {} gave no fit.", b.method, b.runs, b.how, b.block, b.failed));
    for (const auto& [reason, runs] : b.failures) words.push_back(fmt::format("{}: {} runs: {}", b.method, runs, reason));
    for (const auto& note : b.notes) words.push_back(b.method + ": " + note);
  }
  page.table(rows);
  page.list(words);
}

void profiles(const Resampling& r, Page& page) {
  if (r.profiles.empty()) return;
  Cells rows{{"profile of", "method", "fit ± its sigma", "95 % from", "95 % to", "remarks"}};
  for (const LikelihoodProfile& p : r.profiles) {
    rows.push_back({p.parameter, p.method, in_display_unit(p.best, p.unit, p.sigma), end_of(p.lower_found, p.lower, p.sigma, p.unit),
                    end_of(p.upper_found, p.upper, p.sigma, p.unit), fmt::format("{}", fmt::join(p.words, "; "))});
  }
  page.table(rows);
}

void starts(const Resampling& r, Page& page) {
  if (r.starts.empty()) return;
  Cells rows{{"random starts of", "starts", "reach the reported maximum", "lower", "higher", "not converged", "remarks"}};
  std::vector<std::string> words;
  for (const MultiStart& s : r.starts) {
    rows.push_back({s.method, std::to_string(s.runs), std::to_string(s.same), std::to_string(s.lower), std::to_string(s.higher),
                    std::to_string(s.failed), fmt::format("{}", fmt::join(s.words, "; "))});
    for (const auto& [reason, runs] : s.failures) words.push_back(fmt::format("{}: {} starts: {}", s.method, runs, reason));
  }
  page.table(rows);
  page.list(words);
}

}  // namespace

void resampling_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (!input.resampling) return;
  const Resampling& r = *input.resampling;
  page.section("Bootstrap, profile likelihood and random starts");
  page.paragraph(
      "Three checks of the standard errors: block bootstrap (keeps the residual autocorrelation), profile likelihood, random starts.");
  for (const Figure& figure : interval_figures(r)) draw(figure);
  bootstraps(r, page);
  profiles(r, page);
  starts(r, page);
  page.list(r.notes);
}

}  // namespace misfit::report
