#pragma once

// References
//   [D]  R. B. Davies, Biometrika 74 (1987): tests when a nuisance parameter is present only under the alternative.

#include <functional>
#include <optional>
#include <string>

#include "misfit/data/calibration.h"
#include "misfit/data/candidates.h"
#include "misfit/fit/filter/filter_estimate.h"
#include "misfit/jobs/job_queue.h"
#include "misfit/model/registry.h"

namespace misfit {

/// A fitted model with what it was made of.
struct FittedStudy {
  const FilterEstimate& estimate;
  const ModelRequest& request;  ///< from which the model of the estimate was assembled
  const Registry& registry;
  const std::vector<Signals>& experiments;
};

struct DiscoverOptions {
  int threads = 0;                           ///< 0: one per core; does not change the answer
  const Calibration* calibration = nullptr;  ///< its covariance and tests are priors of sensor effects
  double p_accept = 0.01;                    ///< family-wise
  int max_refits = 6;                        ///< in one wave; which waves there are: lib/misfit/README.md, 6.5, step 1
  std::string only;                          ///< key of an effect: it alone is screened, and the drop of one Gauss–Newton step predicted
  /// With `only`: the best of these candidates is refitted, too, if it may be significant or is seen in the measurements, and stands first;
  /// empty: none is.
  std::function<bool(const Candidate&)> refit_best_of = {};
  ProgressFn progress = {};  ///< called with (done, total) as the search goes on
  /// Where refits are kept as they end, to be shared by ranks and found again by a search that was stopped; nullopt: in memory.
  std::optional<StoredJobs> refits = std::nullopt;
  const std::atomic<bool>* stop = nullptr;  ///< between refits
  double refit_limit = 0.0;                 ///< time limit of each refit [s]; 0: none
  double round_limit = 0.0;                 ///< of the whole search [s]; 0: none; under mpirun there is none
};

/// Ranks what the model could lack (lib/misfit/README.md, 6.3 to 6.5): score tests of every effect in the registry that suits the system
/// and of unknown curves, with shapes scanned; refits of those worth it; groups that the data cannot separate; acceptance by family-wise
/// p-value and held-out gain. With `only` the answer holds that one candidate,
/// its p-value corrected for all families a whole search would look at; no candidate where the effect cannot be screened (it has no
/// strength, does not suit the system, is driven by noise, or another effect stands for it). With `refits` all ranks come to the same
/// answer. RunError: stopped. A refit that its time limit has cut off is named and says nothing of its effect; where that of
/// the round is spent, the answer is what was found until then, and says so (discover/unfinished.h).
[[nodiscard]] Discovery discover(const FittedStudy& fitted, const DiscoverOptions& options = {});

}  // namespace misfit
