#pragma once

#include <vector>

#include "misfit/calibrate/groups.h"
#include "misfit/calibrate/sweep_fit.h"
#include "misfit/data/calibration.h"

namespace misfit {

/// What forward selection works on.
struct SelectionTask {
  SweepData data;
  SweepModel base;                      ///< free whatever the tests say
  std::vector<CameraGroup> candidates;  ///< none of them in `base`
  double threshold = 1e-3;
};

struct Selection {
  SweepFit fit;                   ///< base and the groups selected
  std::vector<CameraTest> tests;  ///< one per candidate, in that order
};

/// Forward selection by F-test (noise unknown): F = ((RSS0 − RSS1)/q) / (RSS1/(N − p)), p-value corrected by Šidák for candidates.size()
/// candidates; the best one below the threshold, determined and inside its bounds is selected, then all are tested again; at last each one
/// selected must still be significant given the others. CameraTest::drop = N log(RSS0/RSS1).
[[nodiscard]] Selection select_parameters(const SelectionTask& task);

}  // namespace misfit
