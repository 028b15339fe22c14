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

/// What the legend says of it.
[[nodiscard]] std::string legend_of(const Series& series);

/// Its part of a plot command; `first` is the number of its first column in the figure's CSV. Empty if there is nothing to draw or to say.
[[nodiscard]] std::string plot_clause(const Figure& figure, const Series& series, std::size_t first);

}  // namespace misfit::report
