#pragma once

// References
//   [AN] S. Amari, H. Nagaoka, Methods of Information Geometry (2000), ch. 2: the Fisher information as a metric.

#include <optional>
#include <utility>
#include <vector>

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// 95 % intervals of noise parameters that are known too poorly for value ± 1.96 sigma: a random force's correlation time, known to a
/// quarter of it, has a sigma half as large where it comes out half as long, so that such an interval misses the truth on one side only.
/// Here the sigma goes along: over the logarithms φ of the noise (pack()) the end for φ_j is where the path dφ/dz = C(φ) e_j / √C_jj(φ) is
/// at z = ± 1.96, with C the inverse of the Fisher information there [AN]: the direction in which the others make up for φ_j, each
/// step as long as a sigma is at that place. One step by the midpoint rule; with C in proportion to a constant it is the usual interval of
/// the logarithm. C(φ) is that of the linearised filter with the parameters fixed, scaled at the estimate to the joint covariance.
///
/// `which`: places in pack(). None where the estimate has no joint covariance, or nothing is known of the parameter (at its bound, sigma of
/// the logarithm above 1). The answer does not depend on `threads`.
[[nodiscard]] std::vector<std::optional<std::pair<double, double>>> noise_intervals(const FilterEstimate& estimate,
                                                                                    const std::vector<std::size_t>& which, int threads);

}  // namespace misfit
