#pragma once

#include <vector>

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// A strength at which its effect is whole (CoefficientSpec::whole).
struct WholeStrength {
  int parameter = -1;
  double value = 0.0;  ///< [unit of the strength]
};

/// Of the model's last effect, at an estimate of it: a share of an output, or of the gain by which the rest of the model lets an input act
/// on the effect's first port. Left out: strengths that have none, and inputs that do not act there.
[[nodiscard]] std::vector<WholeStrength> whole_strengths(const FilterEstimate& estimate);

}  // namespace misfit
