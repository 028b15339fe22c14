#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "misfit/math/statistics.h"

namespace misfit {

/// A step of time that is longer than this times the usual one is a gap, unless such steps are as usual (LongSteps::uneven).
inline constexpr double kGapInSteps = 1.5;

/// The long ones among a recording's steps of time [s].
struct LongSteps {
  double usual = 0.0, longest = 0.0;  ///< [s]; the median
  std::size_t count = 0;              ///< above kGapInSteps of the usual one
  bool uneven = false;                ///< more than a twentieth of all are so long: a clock that jitters, no gaps
};

[[nodiscard]] inline LongSteps long_steps(const std::vector<double>& steps) {
  constexpr std::size_t usual_one_in = 20;
  LongSteps out;
  if (steps.empty()) return out;
  out.usual = median(steps);
  out.longest = *std::max_element(steps.begin(), steps.end());
  for (const double step : steps) out.count += step > kGapInSteps * out.usual ? 1U : 0U;
  out.uneven = usual_one_in * out.count > steps.size();
  return out;
}

}  // namespace misfit
