#pragma once

#include <vector>

#include "misfit/calibrate/sweep_fit.h"

namespace misfit {

/// The points to keep under a fitted camera: those whose coordinates are both within `limit` robust sigmas (MAD over all coordinates,
/// corrected for the free parameters). A point taken for another is wrong in both coordinates, so it goes as a whole.
[[nodiscard]] std::vector<bool> points_within(const std::vector<SweepPoint>& points, double l_b, const SweepFit& fit, double limit);

/// Cauchy fit of `model` to all points, its width following the robust sigma down (at most 20 rounds), started from K and h_c alone.
[[nodiscard]] SweepFit robust_fit(const std::vector<SweepPoint>& points, double l_b, const SweepModel& model);

}  // namespace misfit
