#pragma once

#include <string>
#include <utility>
#include <vector>

#include "misfit/report/figure.h"

namespace misfit::report {

/// The columns that a series writes and draws, in this order: ("x", &x), ("y", &y), …
[[nodiscard]] std::vector<std::pair<const char*, const std::vector<double>*>> columns_of(const Series& series);

/// Does any row of the series have all its numbers?
[[nodiscard]] bool has_data(const Series& series);

/// The script NAME.gp. Columns are counted in the order in which write_figure writes them; series of more than 5000 vertices or 1200 points
/// are thinned for drawing with `every`, never in the CSV. `out` may be set beforehand to draw elsewhere.
[[nodiscard]] std::string gnuplot_script(const Figure& figure);

}  // namespace misfit::report
