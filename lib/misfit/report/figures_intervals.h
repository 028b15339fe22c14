#pragma once

#include <string>
#include <vector>

#include "misfit/data/intervals.h"
#include "misfit/report/figure.h"

namespace misfit::report {

/// One curve over the runs of the bootstraps of several methods: the band that holds 95 % of the runs, their mean, and, dotted, value
/// ± 1.96 sigma of the fit. Only where the fit's curve is visited.
[[nodiscard]] Figure bootstrap_figure(const std::string& curve, const std::vector<Bootstrap>& bootstraps);

/// Drop of the likelihood against the fixed value, over its scale, with the drop of 3.84 that ends the 95 % interval, the interval, and,
/// dotted, the parabola of the fit's sigma. Angles in degrees.
[[nodiscard]] Figure profile_figure(const LikelihoodProfile& profile);

/// How far below the fit's maximum each random start ended, in order; a start that ended above it lies below the line of 0. Logarithmic
/// beyond a drop of 1.
[[nodiscard]] Figure starts_figure(const MultiStart& starts);

/// All of them: a figure per curve, then one per profile and one per method's starts.
[[nodiscard]] std::vector<Figure> interval_figures(const Resampling& resampling);

/// Draws them into `dir`; returns the names of all files, CSV and gnuplot script beside each SVG.
std::vector<std::string> write_interval_figures(const std::filesystem::path& dir, const Resampling& resampling);

}  // namespace misfit::report
