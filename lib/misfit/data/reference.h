#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/fit.h"
#include "misfit/data/folded_angle.h"

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
  std::optional<Estimate> trim;    ///< stable zero of a static moment [of_unit], see math/stable_zero.h
  std::vector<std::string> notes;  ///< what was folded or left out, in words
};

/// Reads `alpha[deg],C_m[-],sigma[-]`: the first column is the argument, then a column named as the curve, then `sigma` where present.
/// Points at negative values of the folded angle are folded to positive ones by the symmetry of the curve. Other arguments stay as they
/// are. The trim is given for the static curve of a system (SystemSpec::static_curve) over its folded angle only. InputErrors as read_csv;
/// also a sigma that is not positive, or no complete row.
[[nodiscard]] Reference read_reference(const std::filesystem::path& path, const std::string& curve, const std::string& static_curve = {},
                                       const FoldedAngle& folded_angle = {});

}  // namespace misfit
