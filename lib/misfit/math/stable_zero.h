#pragma once

#include <optional>
#include <vector>

namespace misfit {

/// Points of a curve, with 1-sigma errors (0: not known).
struct WeightedPoints {
  std::vector<double> x, value, sigma;
  void add(double at, double v, double s) {
    x.push_back(at);
    value.push_back(v);
    sigma.push_back(s);
  }
};

/// By rising x; points of equal x keep their order.
[[nodiscard]] WeightedPoints sorted(const WeightedPoints& points);

/// Where a curve crosses zero [unit of x].
struct ZeroCrossing {
  double x = 0.0, sigma = 0.0;  ///< sigma 0: not known
};

/// The stable zero crossing (from + to −, slope negative) of weighted points.
///   The points of equal x (the two branches) are averaged to find the crossing: the last change of sign from + to −, where "last" means
///   the one at the largest x. Then a parabola (a line if there are fewer than 4 distinct x) is fitted, weighted with 1/sigma², to the
///   nearest three distinct x on either side, and its zero in the bracket (or within one bracket's width of it) is the trim. sigma =
///   sqrt(g' C g), g = −(1, x, x²)/slope, C the fit's covariance, multiplied by chi²/(n − p) where that is above 1 (branches that disagree
///   by more than their sigmas widen the result).
/// Assumes independent errors. nullopt: no such crossing of the means or of the parabola. Without sigmas, equal weights
/// and the scatter alone give sigma (0 if nothing is left over to estimate it).
[[nodiscard]] std::optional<ZeroCrossing> stable_zero(const WeightedPoints& given);

}  // namespace misfit
