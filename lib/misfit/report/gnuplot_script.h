#pragma once

#include <string>

#include "misfit/report/figure.h"

namespace misfit::report {

/// The script NAME.gp. Columns are counted in the order in which write_figure writes them; series of more than 5000 vertices or 1200 points
/// are thinned for drawing with `every`, never in the CSV. `out` may be set beforehand to draw elsewhere.
[[nodiscard]] std::string gnuplot_script(const Figure& figure);

}  // namespace misfit::report
