// How well the results are known: propagated uncertainty, bootstrap, profile likelihood, random starts.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/show/results.h"
#include "misfit/show/rows.h"

namespace misfit {
namespace {

/// Two significant digits.
std::string sigma_text(double sigma, const std::string& si) {
  return std::isfinite(sigma) ? with_display_unit(fmt::format("{:.2g}", display_value(sigma, si)), si) : kMissing;
}

/// To the place that its sigma is known to.
std::string without_sigma(double value, double sigma, const std::string& si) {
  const std::string both = format_value(display_value(value, si), display_value(sigma, si));
  const bool power_of_ten = both.starts_with('(');  // (1.20 ± 0.10)e7
  return power_of_ten ? in_display_unit(value, si) : with_display_unit(both.substr(0, both.find(" ±")), si);
}

TableBlock perturbed_table(const Uncertainty& u) {
  TableBlock table{columns("perturbed|nominal|sigma|distribution")};
  for (const PerturbedParameter& p : u.perturbed)
    table.rows.push_back({p.name, in_display_unit(p.value, p.unit), sigma_text(p.sigma, p.unit), p.distribution});
  return table;
}

TableBlock number_table(const Uncertainty& u) {
  TableBlock table{columns("result|nominal ± sigma (noise)|mean|propagated sigma|3-sigma band|>runs")};
  for (const SpreadNumber& n : u.numbers) {
    const bool spread = std::isfinite(n.sigma);
    table.rows.push_back({n.name, in_display_unit(n.nominal, n.unit, n.nominal_sigma), without_sigma(n.mean, n.sigma, n.unit),
                          sigma_text(n.sigma, n.unit),
                          spread ? interval_in_display_unit(n.mean - 3.0 * n.sigma, n.mean + 3.0 * n.sigma, n.unit, n.sigma) : kMissing,
                          std::to_string(n.count)});
  }
  return table;
}

using Numbers = std::vector<const SpreadNumber*>;

/// Two columns per number; the sign of the second says which way the number goes when the parameter grows.
TableBlock share_table(const Numbers& numbers) {
  TableBlock table{columns("share of the variance")};
  std::vector<std::string> interactions{"interactions"};
  for (const VarianceShare& share : numbers.front()->shares) table.rows.push_back({share.name});
  for (const SpreadNumber* n : numbers) {
    table.columns.push_back({n->name, Align::right});
    table.columns.push_back({"per sigma", Align::right});
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const VarianceShare& s = n->shares[i];
      table.rows[i].push_back(fmt::format("{:.1f} ± {:.1f} %", 100.0 * s.share, 100.0 * s.sigma));
      table.rows[i].push_back((s.effect > 0.0 ? "+" : "") + sigma_text(s.effect, n->unit));
    }
    interactions.push_back(fmt::format("{:.1f} %", 100.0 * n->rest));
    interactions.emplace_back();
  }
  table.rows.push_back(std::move(interactions));
  return table;
}

void add_shares(const Uncertainty& u, Blocks& out) {
  constexpr std::size_t numbers_per_table = 4;
  Numbers numbers;
  const auto put = [&] {
    if (!numbers.empty()) out.table(share_table(numbers));
    numbers.clear();
  };
  for (const SpreadNumber& n : u.numbers) {
    if (!n.shares.empty()) numbers.push_back(&n);
    if (numbers.size() == numbers_per_table) put();
  }
  put();
}

void add_failures(const std::string& of, const std::map<std::string, std::size_t>& failures, std::size_t runs,
                  std::vector<std::string>& out) {
  for (const auto& [reason, count] : failures) out.push_back(fmt::format("{}: {} of {} runs gave no result: {}", of, count, runs, reason));
}

/// The end of an interval, to a tenth of the sigma; it has no sigma of its own.
std::string end_of(double value, double sigma, const std::string& si, bool found = true) {
  constexpr double fine = 0.1;
  return found ? without_sigma(value, fine * sigma, si) : "not reached";
}

void add_bootstraps(const std::vector<Bootstrap>& bootstraps, Blocks& out) {
  TableBlock table{columns("block bootstrap of|result|fit ± sigma|mean ± sigma of the runs|2.5 %|97.5 %|>runs")};
  std::vector<std::string> remarks, warnings;
  for (const Bootstrap& b : bootstraps) {
    for (const BootstrapNumber& n : b.numbers) {
      table.rows.push_back({b.method, n.name, in_display_unit(n.value, n.unit, n.fit_sigma), in_display_unit(n.mean, n.unit, n.sigma),
                            end_of(n.lower, n.sigma, n.unit), end_of(n.upper, n.sigma, n.unit), std::to_string(n.runs)});
    }
    remarks.push_back(fmt::format("{}: {} runs of {}, blocks of {} samples; {} failed.", b.method, b.runs, b.how, b.block, b.failed));
    add_failures(b.method, b.failures, b.runs, warnings);
    for (const std::string& note : b.notes) warnings.push_back(b.method + ": " + note);
  }
  out.table(std::move(table));
  out.list({remarks});
  out.warnings(warnings);
}

void add_profiles(const std::vector<LikelihoodProfile>& profiles, Blocks& out) {
  TableBlock table{columns("profile likelihood of|method|fit ± sigma|95 % from|95 % to")};
  std::vector<std::string> remarks;
  for (const LikelihoodProfile& p : profiles) {
    table.rows.push_back({p.parameter, p.method, in_display_unit(p.best, p.unit, p.sigma), end_of(p.lower, p.sigma, p.unit, p.lower_found),
                          end_of(p.upper, p.sigma, p.unit, p.upper_found)});
    for (const std::string& words : p.words) remarks.push_back(p.parameter + ", " + p.method + ": " + words);
  }
  out.table(std::move(table));
  out.list({remarks});
}

void add_starts(const std::vector<MultiStart>& starts, Blocks& out) {
  TableBlock table{columns("random starts of|>starts|>reach the reported maximum|>a lower one|>a higher one|>not converged")};
  std::vector<std::string> remarks, warnings;
  for (const MultiStart& s : starts) {
    table.rows.push_back({s.method, std::to_string(s.runs), std::to_string(s.same), std::to_string(s.lower), std::to_string(s.higher),
                          std::to_string(s.failed)});
    for (const std::string& words : s.words) (s.higher > 0 ? warnings : remarks).push_back(s.method + ": " + words);
    add_failures(s.method, s.failures, s.runs, remarks);
  }
  out.table(std::move(table));
  out.list({remarks});
  out.warnings(warnings);
}

}  // namespace

Blocks blocks_of(const Uncertainty& u) {
  Blocks out;
  out.heading("Propagated uncertainty");
  out.paragraph(fmt::format("Monte Carlo: the data reduction ({}) is repeated {} with perturbed inputs (seed {}); {}.", u.method,
                            counted(u.runs, "time", "times"), u.seed, counted(u.failed, "run failed", "runs failed")));
  out.table(perturbed_table(u));
  out.figures("bands");
  out.table(number_table(u));
  add_shares(u, out);
  std::vector<std::string> warnings = u.notes;
  add_failures(u.method, u.failures, u.runs, warnings);
  out.warnings(warnings);
  return out;
}

Blocks blocks_of(const Resampling& r) {
  Blocks out;
  if (r.bootstraps.empty() && r.profiles.empty() && r.starts.empty() && r.notes.empty()) return out;
  out.heading("Bootstrap, profile likelihood and random starts");
  out.paragraph("Checks of the standard errors: block bootstrap (keeps the residual autocorrelation), profile likelihood, random starts.");
  out.figures("intervals");
  add_bootstraps(r.bootstraps, out);
  add_profiles(r.profiles, out);
  add_starts(r.starts, out);
  out.warnings(r.notes);
  return out;
}

}  // namespace misfit
