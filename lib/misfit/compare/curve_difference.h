#pragma once

#include <optional>
#include <vector>

#include "misfit/data/comparison.h"
#include "misfit/data/fit.h"

namespace misfit {

/// Value and sigma of a curve at one argument.
struct CurveValue {
  double x = 0.0, value = 0.0, sigma = 0.0;
};

/// Linear interpolation of value and sigma between neighbouring grid points that were both visited (count > 0, values finite); nullopt
/// elsewhere. `curve.x` ascending.
[[nodiscard]] std::optional<CurveValue> visited_point(const CurveEstimate& curve, double x);

/// The visited grid points themselves.
[[nodiscard]] std::vector<CurveValue> visited_points(const CurveEstimate& curve);

/// Half the distance over which a slope is taken: 1/20 of the visited range, at least one grid step.
///   slope = (c(x + h) − c(x − h)) / 2h,  sigma = sqrt(s(x + h)² + s(x − h)²) / 2h
/// The sigma takes the two ends as independent; neighbouring points of a curve share their errors, so that it errs to the large side.
/// nullopt where either end was not visited. Unit: curve's unit per of_unit.
[[nodiscard]] std::optional<Estimate> slope_at(const CurveEstimate& curve, double x);

/// `curve` against points of something else of the same quantity and unit. Names are left to the caller. nullopt if fewer than two points
/// lie in the visited range of the curve or no point has an uncertainty.
[[nodiscard]] std::optional<CurveDifference> difference(const CurveEstimate& curve, const std::vector<CurveValue>& points);

}  // namespace misfit
