#pragma once

// References
//   [HK] A. C. Harvey, S. J. Koopman, J. Business & Economic Statistics 10 (1992): diagnostic checking of unobserved-components models.
//   [LB] G. M. Ljung, G. E. P. Box, Biometrika 65 (1978).

#include "misfit/data/diagnosis.h"
#include "misfit/fit/filter/filter_estimate.h"
#include "misfit/jobs/work_queue.h"

namespace misfit {

struct DiagnoseOptions {
  int threads = 0;           ///< 0: one per core; does not change the answer
  ProgressFn progress = {};  ///< called with (done, total) maps
};

/// Where the fitted model fails, from its innovations, which under a right model are independent of everything known one step before
/// (lib/misfit/README.md, 6.2): whiteness per channel, maps of the missing force by the score test of hat functions at the predicted state
/// [HK], the smoothed missing force, and the conclusions in plain sentences.
[[nodiscard]] Diagnosis diagnose(const FilterEstimate& estimate, const DiagnoseOptions& options = {});

/// A sentence on the most significant run of neighbouring hats of one sign, with its mean and ± one sigma; where none is significant by
/// itself, of the whole. `covariance`: of the amplitudes.
[[nodiscard]] std::string where_it_fails(const ForceMap& map, const Eigen::MatrixXd& covariance);

}  // namespace misfit
