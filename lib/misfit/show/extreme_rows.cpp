#include "misfit/show/extreme_rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace misfit {
namespace {

/// Of the rows from `from` to before `to`.
void add_extremes(const std::vector<double>& values, std::size_t from, std::size_t to, std::vector<std::size_t>& rows) {
  std::size_t least = to, largest = to, first_gap = to, last_gap = to;
  for (std::size_t k = from; k < to; ++k) {
    if (!std::isfinite(values[k])) {
      first_gap = first_gap == to ? k : first_gap;
      last_gap = k;
      continue;
    }
    if (least == to || values[k] < values[least]) least = k;
    if (largest == to || values[k] > values[largest]) largest = k;
  }
  if (least != to) rows.insert(rows.end(), {least, largest});
  if (first_gap != to) rows.insert(rows.end(), {first_gap, last_gap});
}

}  // namespace

std::vector<std::size_t> extreme_rows(const std::vector<const std::vector<double>*>& lists, std::size_t most) {
  const std::size_t rows = lists.empty() ? 0 : lists.front()->size();
  std::vector<std::size_t> out;
  if (rows <= most) {
    out.resize(rows);
    std::iota(out.begin(), out.end(), std::size_t{0});
    return out;
  }
  const std::size_t stretches = std::max<std::size_t>(most / (2 * lists.size()), 1);
  for (std::size_t s = 0; s < stretches; ++s) {
    for (const std::vector<double>* values : lists) add_extremes(*values, s * rows / stretches, (s + 1) * rows / stretches, out);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace misfit
