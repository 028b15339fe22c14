#pragma once

#include <array>

#include "misfit/track/marker.h"

namespace misfit {

/// The marker fitted to the pixels about a place.
struct Location {
  bool converged = false;  ///< false: the rest says nothing
  bool inside = false;     ///< the whole marker lies in the frame
  PixelPoint at;           ///< centre
  double sigma = 0.0;      ///< [px] standard deviation of one coordinate
  std::array<double, 3> levels{0, 0, 0};
  double noise = 0.0;           ///< RMS of what the marker does not explain [grey levels]
  double explained = 0.0;       ///< share of the variance of the pixels that the marker explains
  double weakest_sector = 0.0;  ///< the marker's strength in the worst of eight sectors, over its strength in all (1 = evenly there)
  double outer = 0.0, inner = 0.0, edge = 0.0;  ///< shape used, or fitted
};

/// Least squares over the pixels within the marker's reach and a margin (Gauss-Newton with Huber's weights, k = 2 robust standard
/// deviations), in centre and levels and, with `fit_shape`, in outer, inner and edge. sigma comes from the sandwich H^-1 M H^-1, where M
/// sums J_i r_i r_j J_j over pixels up to four columns and two lines apart (Bartlett weights): texture and compression make neighbours
/// alike, which the classical formula does not know. 0.01 px is added for what the shape is not. What moves the whole marker alike no
/// residual shows: see pixel_locking. `start` must
/// be within about half an edge or ring width of the centre.
[[nodiscard]] Location locate(const Field& field, const Marker& marker, const PixelPoint& start, bool fit_shape = false);

}  // namespace misfit
