#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "misfit/data/reference.h"
#include "misfit/data/uncertainty.h"
#include "misfit/report/figure.h"

namespace misfit::report {

/// One curve over the runs: mean with its 3-sigma band, the nominal fit, the points of the references, and for the curve whose zero is the
/// trim its 3-sigma interval on the zero line (the paper's Figs. 9, 10). Paler where fewer than half of the runs reach.
[[nodiscard]] Figure spread_figure(const SpreadCurve& curve, const Uncertainty& uncertainty, const std::vector<Reference>& references);

/// Which parameter of the set-up how much of the variance comes from: bars for the trim and, beside it, for the slope of its curve (for the
/// first two numbers where there is no trim).
[[nodiscard]] Figure shares_figure(const Uncertainty& uncertainty);

/// All of them, in the order of a page.
[[nodiscard]] std::vector<Figure> uncertainty_figures(const Uncertainty& uncertainty, const std::vector<Reference>& references);
/// Drawn into `dir`; returns the names of the files.
std::vector<std::string> write_uncertainty_figures(const std::filesystem::path& dir, const Uncertainty& uncertainty,
                                                   const std::vector<Reference>& references);

}  // namespace misfit::report
