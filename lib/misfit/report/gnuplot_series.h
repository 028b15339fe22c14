#pragma once

#include <string>
#include <utility>
#include <vector>

#include "misfit/report/figure.h"

namespace misfit::report {

/// The columns that a series writes and draws, in this order: ("x", &x), ("y", &y), …
[[nodiscard]] std::vector<std::pair<const char*, const std::vector<double>*>> columns_of(const Series& series);

/// Does this column of columns_of() run along x, and so have the unit of x?
[[nodiscard]] bool along_x(Style style, const std::string& column);

/// Is only a part of its rows drawn? A drawing of thousands of vertices, or of hundreds of dots, is too large for a page.
[[nodiscard]] bool is_thinned(const Series& series);

/// That part. Of lines, steps and bands: the extremes of stretches and where they break (show/extreme_rows.h). Of dots: one of each place
/// of a grid over the axes, as fine as their number allows.
[[nodiscard]] Series drawn_part(const Figure& figure, const Panel& panel, const Series& series);

/// How many columns it has in the figure's CSV: where it is thinned, those of the part that is drawn stand behind its own.
[[nodiscard]] std::size_t columns_written(const Series& series);

/// Does any row of the series have all its numbers?
[[nodiscard]] bool has_data(const Series& series);

/// What the legend says of it.
[[nodiscard]] std::string legend_of(const Series& series);

/// Its part of a plot command; `first` is the number of its first column in the figure's CSV. Empty if there is nothing to draw or to say.
[[nodiscard]] std::string plot_clause(const Figure& figure, const Series& series, std::size_t first);

}  // namespace misfit::report
