#include "misfit/recording/rates.h"

#include <cmath>

namespace misfit {
namespace {

/// By the trapezium rule over the rows from … to, as of equal intervals; of two intervals the middle value.
double mean_between(const std::vector<double>& values, std::size_t from, std::size_t to) {
  if (to - from == 2) return values[from + 1];
  double sum = 0.5 * (values[from] + values[to]);
  for (std::size_t i = from + 1; i < to; ++i) sum += values[i];
  return sum / static_cast<double>(to - from);
}

bool is_rate_over(std::size_t span, const std::vector<double>& rate, const std::vector<double>& level, double factor,
                  const RowTimes& rows) {
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const auto& piece : rows.pieces) {
    for (std::size_t k = span; k + span < piece.size(); ++k) {
      const std::size_t before = piece[k - span], after = piece[k + span];
      const double x = factor * (level[after] - level[before]) / (rows.t[after] - rows.t[before]);
      const double y = mean_between(rate, before, after);
      if (!std::isfinite(x) || !std::isfinite(y)) continue;
      xx += x * x;
      xy += x * y;
      yy += y * y;
    }
  }
  constexpr double alike = 0.98, near_one = 0.1;
  return xx > 0.0 && yy > 0.0 && xy * xy > alike * xx * yy && std::abs(xy / xx - 1.0) < near_one;
}

}  // namespace

bool is_rate_of(const std::vector<double>& rate, const std::vector<double>& level, double factor, const RowTimes& rows) {
  constexpr std::size_t longest = 64;
  for (std::size_t span = 1; span <= longest && 40 * span < rows.t.size(); span *= 2) {
    if (is_rate_over(span, rate, level, factor, rows)) return true;
  }
  return false;
}

}  // namespace misfit
