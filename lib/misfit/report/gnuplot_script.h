#pragma once

#include <string>

#include "misfit/report/figure.h"

namespace misfit::report {

/// The script NAME.gp. Columns are counted in the order in which write_figure writes them; of series of more than 5000 vertices or 3000
/// dots it draws the part that stands in columns of its own (gnuplot_series.h). `out` may be set beforehand to draw elsewhere.
[[nodiscard]] std::string gnuplot_script(const Figure& figure);

}  // namespace misfit::report
