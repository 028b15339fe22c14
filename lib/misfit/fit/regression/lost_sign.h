#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/data/signals.h"

namespace misfit {

/// A recording whose output has its sign back.
struct SignedRecord {
  std::vector<Signals> experiments;
  int changes = 0;    ///< of sign
  double left = 1.0;  ///< of the squares of the residuals of such a regression without signs
};

/// Signs s(k) = ±1 with which an output that is never negative is predicted best by
///
///     s(k) y(k) = a s(k-1) y(k-1) + b s(k-2) y(k-2) + c'r(k) + d,
///
/// r the inputs now and a sample before and the other outputs a sample before (an ARX model: Ljung, System Identification (1999), 4.2): by
/// turns a, b, c and d by least squares, and the signs by dynamic programming (Viterbi, IEEE Trans. Inf. Theory 13 (1967) 260). Begun from
/// an output that goes through zero wherever it comes close to it, and from one that has the sign of each r about its median; the best of
/// these. Which of the two signs is the positive one no output can tell: that with which the first input raises it, or, without inputs, for
/// which it is mostly positive. The samples are taken as evenly spaced; samples whose past is missing are missing in the answer,
/// held-out ones do not count in the regression, and inputs without values are left out.
///
/// nullopt: the output is negative somewhere, beyond noise; or with signs the regression leaves more than half of what it leaves without.
[[nodiscard]] std::optional<SignedRecord> with_signs(const std::vector<Signals>& experiments, const std::string& output);

}  // namespace misfit
