#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "misfit/formula/graph.h"
#include "misfit/formula/measure.h"
#include "misfit/formula/syntax.h"

// From the syntax tree to the graph, with units checked on the way.

namespace misfit::formula {

/// What a name stands for.
struct Meaning {
  int node = 0;
  Measure measure;
};

/// Names that formulas may use.
struct Names {
  std::function<std::optional<Meaning>(const std::string& name)> find;
  std::vector<std::string> all;                                      ///< for suggestions
  std::function<std::string(const std::string& name)> refusal = {};  ///< why a known name must not be used here; empty: it may
};

/// Translates a formula. InputError with place, both units and the part, where a name is unknown or units do not match:
///   + − min max if saturate < … : both sides alike (the number 0 fits all);  sin exp log …: no unit, or an angle;  sqrt and constant
///   powers: any unit;  other powers: none.
/// Optional last argument of abs, sign, min, max, saturate, in the unit of the first: the width w over which a kink or a jump is rounded:
///   abs(x, w) = sqrt(x² + w²),  sign(x, w) = tanh(x/w),  max(a, b, w) = (a + b + abs(a − b, w))/2, min likewise, saturate by these;
///   smooth_step(x, w) = (1 + tanh(x/w))/2.
/// Kinks and jumps in a fit: where a formula only has a kink (abs, min, max, saturate, if with equal values on both sides) the motion has a
/// continuous derivative by every parameter, also by a level inside, and the fit converges with the derivatives of the branch taken
/// (Graph::derivatives). A step that runs over the kink is accurate to its square. Where a formula jumps (sign, comparisons, if) a level
/// inside has no derivative at all: give a width of about the change of the argument over one sample; it is a parameter like any other and
/// can be lowered from fit to fit. Integrators sub-step for the width (the formula at its steepest).
/// Nodes get the origin `origin + (number of the expression)`.
[[nodiscard]] Meaning build(const Syntax& syntax, const Names& names, Graph& graph, int origin);

/// InputError unless the formula has the unit `wanted`.
void check_unit(const Syntax& syntax, const Meaning& found, const Measure& wanted, const std::string& of);

}  // namespace misfit::formula
