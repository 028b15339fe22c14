#pragma once

#include "misfit/core/units.h"

namespace misfit {

/// Bins of sliding_bin where a study does not say: the paper's (lib/misfit/README.md, [1]). The reference of the keys, resolved.toml and
/// the method read them here.
struct BinSize {
  double width = 1.5 * kDegree;  ///< [rad]: "typical" in the paper
  double step = 0.1 * kDegree;   ///< [rad]: as in the paper's example
};

}  // namespace misfit
