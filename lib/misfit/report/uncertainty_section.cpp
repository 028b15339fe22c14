#include <fmt/format.h>

#include <cmath>

#include "misfit/core/display.h"
#include "misfit/report/figures_uncertainty.h"
#include "misfit/report/rows.h"
#include "misfit/report/sections.h"

namespace misfit::report {
namespace {

using Cells = std::vector<std::vector<std::string>>;

Cells perturbed_rows(const Uncertainty& u) {
  Cells rows{{"perturbed", "nominal ± sigma", "how it was read"}};
  for (const PerturbedParameter& p : u.perturbed) rows.push_back({p.name, in_display_unit(p.value, p.unit, p.sigma), p.reading});
  return rows;
}

Cells number_rows(const Uncertainty& u) {
  Cells rows{{"result", "nominal ± sigma (noise)", "mean ± propagated sigma", "runs"}};
  for (const SpreadNumber& n : u.numbers)
    rows.push_back(
        {n.name, in_display_unit(n.nominal, n.unit, n.nominal_sigma), in_display_unit(n.mean, n.unit, n.sigma), std::to_string(n.count)});
  return rows;
}

Cells share_rows(const Uncertainty& u) {
  Cells rows{{"share of the variance"}};
  for (const SpreadNumber& n : u.numbers) {
    if (n.shares.empty()) continue;
    rows.front().push_back(n.name);
    for (std::size_t i = 0; i < n.shares.size(); ++i) {
      if (rows.size() < i + 2) rows.push_back({n.shares[i].name});
      rows[i + 1].push_back(fmt::format("{:.1f} ± {:.1f} %", 100.0 * n.shares[i].share, 100.0 * n.shares[i].sigma));
    }
  }
  return rows;
}

}  // namespace

void uncertainty_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (!input.uncertainty) return;
  const Uncertainty& u = *input.uncertainty;
  page.section("Propagated uncertainty");
  page.paragraph(fmt::format("Monte Carlo: the data reduction ({}) is repeated {} times with perturbed inputs; {} runs gave no result.",
                             u.method, u.runs, u.failed));
  page.table(perturbed_rows(u));
  for (const Figure& figure : uncertainty_figures(u, input.references)) draw(figure);
  page.table(number_rows(u));
  page.table(share_rows(u));
  page.list(u.notes);
}

}  // namespace misfit::report
