#pragma once

#include <functional>
#include <optional>
#include <random>

#include "misfit/data/fit.h"
#include "misfit/data/multi_start.h"
#include "misfit/jobs/job_queue.h"
#include "misfit/model/model.h"
#include "misfit/uncertainty/chain_result.h"

namespace misfit {

/// Where a search ended.
struct Maximum {
  std::optional<double> objective;  ///< penalised log-likelihood; nullopt: it ended nowhere …
  std::string why;                  ///< … for this reason
  std::vector<double> values;       ///< of all parameters there
};
/// Where a search begins.
struct RandomStart {
  std::vector<double> values;         ///< of all parameters
  std::vector<double> noise_factors;  ///< standard deviation of the noise of every output, then of the random force, over its usual one
};
/// The search from there, roughness as in the fit; called from several threads at once.
using SearchFrom = std::function<Maximum(const RandomStart& start)>;

/// What the searches are to find again. Keeps references.
struct FoundMaximum {
  const Fit& fit;
  const Model& model;      ///< at the fit
  double objective = 0.0;  ///< what the search makes of it
};

struct MultiStartOptions {
  std::size_t runs = 20;
  unsigned long long seed = 1;
};

/// Values about the model's: a parameter with a prior is drawn from it, any other free one is moved by its typical size times a normal
/// number; a curve by a straight line over its knots whose level and slope are drawn so. Bounds are kept. Of the noise the logarithms are
/// moved by a normal number: which output a model follows that cannot follow all hangs on it.
[[nodiscard]] RandomStart random_start(const Model& model, std::mt19937_64& random);

/// The fit again from random starts: is there a higher maximum than the one that was found, and how many searches find it? Start k depends
/// on the seed and its own number alone.
class MultiStarts {
 public:
  /// InputError: there is no start; RunError: nothing is free.
  MultiStarts(const FoundMaximum& found, SearchFrom search, const MultiStartOptions& options);

  [[nodiscard]] std::size_t runs() const { return options_.runs; }
  /// Drop, then the numbers of MultiStart::numbers; none and the reason if the search ended nowhere.
  [[nodiscard]] ChainResult run(std::size_t k) const;
  /// RunError if no start gave a fit.
  [[nodiscard]] MultiStart summary(const std::vector<ChainResult>& results) const;

 private:
  const Fit& fit_;
  const Model& best_;
  double objective_;
  SearchFrom search_;
  MultiStartOptions options_;
  std::vector<int> shown_;  ///< parameters
};

}  // namespace misfit
