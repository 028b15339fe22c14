#pragma once

// Is one column the derivative of another? Not for other files than recording.cpp.

#include <vector>

namespace misfit {

/// Times [s] of the rows, and the rows of each recording.
struct RowTimes {
  const std::vector<double>& t;
  const std::vector<std::vector<std::size_t>>& pieces;
};

/// Means of `rate` against differences of `level`, times `factor` in its unit per second, over 1, 2, 4 … 64 rows to each side, since noise
/// hides the derivative of what is sampled quickly: their cosine is above 0.99 and the slope within 10 % of 1 over one of these spans.
[[nodiscard]] bool is_rate_of(const std::vector<double>& rate, const std::vector<double>& level, double factor, const RowTimes& rows);

}  // namespace misfit
