#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "misfit/jobs/job_queue.h"
#include "misfit/uncertainty/chain_result.h"
#include "misfit/uncertainty/perturbation.h"
#include "misfit/uncertainty/variance_shares.h"

namespace misfit {

/// From errors of the set-up (order of Perturbations::names()) to numbers. Called from several threads at once; depends on nothing but the
/// errors.
using Chain = std::function<ChainResult(const std::vector<double>& errors)>;

/// Mean and standard deviation over the runs that have the number.
struct Moments {
  double mean = 0.0, sigma = 0.0;  ///< NaN with no run, sigma with fewer than two
  std::size_t count = 0;
};

struct MonteCarloResult {
  std::size_t runs = 0, failed = 0;
  std::map<std::string, std::size_t> failures;  ///< reason → runs; beyond twenty reasons the others are counted together
  std::vector<Moments> numbers;
  std::vector<VarianceShares> shares;  ///< of the first `shared` numbers
};

struct MonteCarloOptions {
  StoredJobs jobs;         ///< count: the runs
  std::size_t shared = 0;  ///< the first so many numbers get variance shares
  ProgressFn progress = {};
  const std::atomic<bool>* stop = nullptr;
};

/// Runs the chain once per draw, over threads and ranks, every result on disk at once; then one pass over them in the order of the runs
/// (so that sums have the same bits for any number of threads and ranks). nullopt if it was stopped; on ranks other than the first the
/// result is empty. RunError if every run fails (with the reason of the most) or the disk is full.
[[nodiscard]] std::optional<MonteCarloResult> monte_carlo(const Sampler& sampler, const Chain& chain, const MonteCarloOptions& options);

}  // namespace misfit
