#include "misfit/report/extent.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace misfit::report {

std::array<double, 2> extent_of(const std::vector<double>& values) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::array<double, 2> out{infinite, -infinite};
  for (const double v : values) {
    if (std::isfinite(v)) out = {std::min(out[0], v), std::max(out[1], v)};
  }
  return out;
}

int digits_before_span(const std::array<double, 2>& range) {
  if (!(range[1] > range[0])) return 0;
  const double most = std::max(std::abs(range[0]), std::abs(range[1]));
  return std::max(0, static_cast<int>(std::ceil(std::log10(most / (range[1] - range[0])))));
}

}  // namespace misfit::report
