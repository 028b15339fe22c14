#pragma once

#include <string>
#include <vector>

namespace misfit {

/// An angle that a model has without sign and tests may give with one: SystemSpec::folded_angle.
struct FoldedAngle {
  std::string name, signed_name;         ///< "alpha_T", "alpha"; empty: none
  std::vector<std::string> even_curves;  ///< even in the signed angle: derivatives by a rate; all others are odd, as every moment
};

}  // namespace misfit
