#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/fit.h"

namespace misfit {

/// A curve measured elsewhere, given as points: the static test of the same canopy, say.
struct Reference {
  std::string name;                ///< what it is called in tables and legends: the file's stem, "static_test"
  std::string curve;               ///< "C_m"
  std::string of, of_unit;         ///< "alpha_T", "rad"
  std::string unit;                ///< of the value: "-"
  std::vector<double> x;           ///< [of_unit], ascending; both branches of a signed angle are kept as points of their own
  std::vector<double> value;       ///< [unit]
  std::vector<double> sigma;       ///< [unit]; 0 where the file gives none
  std::optional<Estimate> trim;    ///< stable zero of a static moment [of_unit], see stable_zero()
  std::vector<std::string> notes;  ///< what was folded or left out, in words
};

/// Reads `alpha[deg],C_m[-],sigma[-]`: the first column is the argument, then a column named as the curve, then `sigma` where present.
/// A column `alpha` (or `alpha_T` with negative values) is a signed angle and is folded to alpha_T >= 0 by the symmetry of an axisymmetric
/// canopy: C_m(−a) = −C_m(a), as every moment; derivatives by a rate (names with "dot" or "mq") are even. Other arguments stay as they are.
/// The trim is given for the curve C_m only. InputErrors as read_csv; also a sigma that is not positive, or no complete row.
[[nodiscard]] Reference read_reference(const std::filesystem::path& path, const std::string& curve);

/// The stable zero crossing (from + to −, slope negative) of weighted points.
///   The points of equal x (the two branches) are averaged to find the crossing: the last change of sign from + to −, where "last" means
///   the one at the largest x. Then a parabola (a line if there are fewer than 4 distinct x) is fitted, weighted with 1/sigma², to the
///   nearest three distinct x on either side, and its zero in the bracket (or within one bracket's width of it) is the trim. sigma =
///   sqrt(g' C g), g = −(1, x, x²)/slope, C the fit's covariance, multiplied by chi²/(n − p) where that is above 1 (branches that disagree
///   by more than their sigmas widen the result).
/// Assumes independent errors. nullopt: no such crossing of the means or of the parabola. Without sigmas, equal weights
/// and the scatter alone give sigma (0 if nothing is left over to estimate it).
[[nodiscard]] std::optional<Estimate> stable_zero(const std::vector<double>& x, const std::vector<double>& value,
                                                  const std::vector<double>& sigma, const std::string& unit);

}  // namespace misfit
