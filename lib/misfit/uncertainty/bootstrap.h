#pragma once

// References
//   [DH] A. C. Davison, D. V. Hinkley, Bootstrap Methods and their Application (1997), ch. 5 (percentiles), ch. 8 (time series).

#include <functional>
#include <optional>

#include "misfit/data/intervals.h"
#include "misfit/jobs/work_queue.h"
#include "misfit/uncertainty/chain_result.h"
#include "misfit/uncertainty/resample.h"

namespace misfit {

struct BootstrapOptions {
  std::size_t runs = 200;
  unsigned long long seed = 1;
  BlockLength block;
};

/// From experiments to a fit, knots, roughness and start as in the nominal fit; one that has not converged is a run that failed, and so is
/// a RunError. Called from several threads at once.
using FitReplica = std::function<Fit(const std::vector<Signals>&)>;

/// Block bootstrap of a fit: every run draws replicas of the experiments (Resampler) and fits them. A run depends on the seed and its own
/// number alone. What it says: scatter by noise with its memory, through the whole nonlinear estimation; not: the bias by roughness, priors
/// (they are fixed), or errors of the rig (Monte-Carlo).
class BlockBootstrap {
 public:
  /// Keeps references to `fit` and `experiments`. InputError: fewer than 2 runs, and what Resampler throws.
  BlockBootstrap(const Fit& fit, const std::vector<Signals>& experiments, Resampled what, FitReplica refit,
                 const BootstrapOptions& options);

  [[nodiscard]] std::size_t runs() const { return options_.runs; }
  /// Numbers of run k: scalar parameters in the order of the fit's names (curve coefficients left out), trim, curves on the fit's grids;
  /// NaN where it has none; none and the reason if it failed.
  [[nodiscard]] ChainResult run(std::size_t k) const;
  /// Means, standard deviations and percentiles [DH] over runs in their order. RunError if fewer than half of them gave a fit.
  [[nodiscard]] Bootstrap summary(const std::vector<ChainResult>& results) const;

 private:
  [[nodiscard]] std::vector<double> numbers_of(const Fit& fit) const;

  const Fit& fit_;
  BootstrapOptions options_;
  Resampled what_;
  FitReplica refit_;
  Resampler resampler_;
  std::vector<std::string> names_;
  std::size_t size_ = 0;
};

/// All runs over threads (0: one per core), which do not change the answer. RunError as summary(), or if it was stopped.
[[nodiscard]] Bootstrap block_bootstrap(const BlockBootstrap& bootstrap, int threads, const ProgressFn& progress = {},
                                        const std::atomic<bool>* stop = nullptr);

}  // namespace misfit
