#pragma once

// References
//   [BW] D. M. Bates, D. G. Watts, Nonlinear Regression Analysis and Its Applications (1988), ch. 6: profiles.
//   [CB] R. E. Chandler, S. Bate, Biometrika 94 (2007): likelihoods of dependent data made right by a vertical scale.

#include <functional>
#include <optional>

#include "misfit/data/intervals.h"
#include "misfit/jobs/job_queue.h"

namespace misfit {

/// The penalised log-likelihood at its maximum over everything but one parameter, which is fixed at the value given; nullopt where the
/// model cannot be run or the search did not end. Called with values that move away from the estimate step by step, so that each maximum
/// starts from the one before. One object per side: it may keep what it found.
using MaximumAtFixedValue = std::function<std::optional<double>(double value)>;

/// One parameter to look at.
struct ProfileRequest {
  std::string method, parameter, unit;
  double best = 0.0;       ///< the estimate
  double objective = 0.0;  ///< penalised log-likelihood there
  double sigma = 0.0, plain_sigma = 0.0;
  double lower = 0.0, upper = 0.0;                 ///< bounds of the parameter
  std::function<MaximumAtFixedValue()> from_best;  ///< a fresh search that starts from the estimate; called once per side, from any thread
};

/// Steps the parameter away on both sides, half a sigma at a time, everything else estimated anew, until the drop 2 [log L(best) −
/// log L(value)] passes 3.84 × scale; that value is then found on sqrt(drop), a straight line where the likelihood is a normal one [BW].
/// `scale` = (sigma/plain_sigma)²: the drop of coloured residuals counted as if they were white is too large (or too small) by it [CB].
/// Ends without a crossing at a bound, after 20 steps, where a search fails, or where the likelihood jumps over the limit; `words` say so.
/// Also said: a likelihood that is higher beside the estimate than at it, and an interval that is lopsided by more than a fifth. One job
/// per parameter and side; the answer does not depend on `threads`. InputError: a sigma that is not positive.
[[nodiscard]] std::vector<LikelihoodProfile> profile_likelihood(const std::vector<ProfileRequest>& requests, int threads,
                                                                const ProgressFn& progress = {}, const std::atomic<bool>* stop = nullptr);

/// The same over threads and ranks, each side on disk when it ends (run_stored_jobs(); `jobs.count` follows from the requests). nullopt if
/// it was stopped; on ranks other than the first the result is empty.
[[nodiscard]] std::optional<std::vector<LikelihoodProfile>> stored_profiles(const std::vector<ProfileRequest>& requests,
                                                                            const StoredJobs& jobs, const ProgressFn& progress = {},
                                                                            const std::atomic<bool>* stop = nullptr);

}  // namespace misfit
