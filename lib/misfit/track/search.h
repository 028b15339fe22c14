#pragma once

#include <cmath>
#include <vector>

#include "misfit/track/marker.h"

namespace misfit {

/// A part of the full frame [px], ends included.
struct Region {
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
};
[[nodiscard]] Region whole(const Field& field);
[[nodiscard]] Region intersection(const Region& a, const Region& b);
[[nodiscard]] inline bool contains(const Region& r, const PixelPoint& p) {
  return p.column >= r.left && p.column <= r.right && p.row >= r.top && p.row <= r.bottom;
}

/// [px]
[[nodiscard]] inline double distance(const PixelPoint& a, const PixelPoint& b) { return std::hypot(a.column - b.column, a.row - b.row); }

struct Match {
  PixelPoint at;
  double score = 0.0;  ///< normalised cross-correlation, −1 … 1
};

/// Places whose neighbourhood looks like the marker: local maxima of the zero-mean normalised cross-correlation with the marker's picture,
/// best first, at least a marker's radius apart, not below `least`. Computed on a grid about eight points to the marker, so good to about
/// one grid step; the marker must lie in the frame, its centre in `region`.
[[nodiscard]] std::vector<Match> search(const Field& field, const Marker& marker, const Region& region, double least, std::size_t most);

}  // namespace misfit
