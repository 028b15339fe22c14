#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/contained_fit.h"
#include "misfit/data/estimators.h"
#include "misfit/fit/filter/filter_estimate.h"
#include "misfit/fit/regression/sliding_bin.h"
#include "misfit/inference/fitted_model.h"

namespace misfit {

/// What a method is given.
struct EstimationTask {
  const Model& model;  ///< in the system's regression form for methods that solve that (EstimatorInfo::regression_form)
  const std::vector<Signals>& experiments;
  std::function<const FittedModel&()> regression = {};  ///< equation_error() of the same, where somebody has it
  SlidingBinOptions bins = {};
  int threads = 0;                             ///< 0: one per core; does not change the answer
  std::optional<ContainedFit> contained = {};  ///< of a method with a random force: to start from, among others
};

/// A fit as others start from it: of replicas of its data, or of the same data with a parameter fixed. Roughness stays as it was chosen.
struct FittedMethod {
  std::string method;                                       ///< EstimatorInfo::name
  FittedModel fitted;                                       ///< penalties with the weights that were chosen
  std::optional<FilterNoise> noise, reference;              ///< of a method with a random force
  std::optional<std::vector<std::vector<SampleRole>>> use;  ///< of the same: which measurements count
  SlidingBinOptions bins = {};
  double time_limit = 0.0;  ///< of every fit from here [s]; 0: none
};

struct Estimation {
  FittedMethod at;                       ///< at.fitted.fit is the fit
  std::optional<FilterEstimate> filter;  ///< of a method with a random force, unless it declined; refers to the task's experiments
};

/// A maximum of the penalised log-likelihood, roughness fixed.
struct Maximisation {
  std::optional<double> objective;  ///< nullopt: the search ended nowhere …
  std::string why;                  ///< … for this reason
  FittedMethod at;                  ///< the fit's, moved to where the search ended
};

/// Where a search for a maximum begins.
struct SearchStart {
  bool fitted = true;  ///< where the fit stands, its noise and initial states too; else at the values of its parameters alone, as a new fit
                       ///< does: initial states and noise are looked for, …
  std::vector<double> noise_factors = {};  ///< … the noise from its usual one times these (AnotherStart)
};

/// One row of the table of estimators: everything that others ask of a method. Several threads may call all of it at once.
struct Estimator {
  const EstimatorInfo& info;
  Estimation (*run)(const EstimationTask& task);
  /// Again from where the fit ended, on other data of the same model (knots are the model's). The roughness is fixed, sigmas are those of
  /// white residuals. RunError: the model cannot be run on these data.
  Fit (*refit)(const FittedMethod& from, const std::vector<Signals>& experiments);
  /// nullptr: the method has no likelihood.
  Maximisation (*maximise)(const FittedMethod& from, const std::vector<Signals>& experiments, const SearchStart& start);
};

/// InputError for a name that no method has.
[[nodiscard]] const Estimator& estimator(const std::string& name);

/// Estimator::refit within the time limit of `from`. RunError, too: it was spent.
[[nodiscard]] Fit refit_in_time(const FittedMethod& from, const std::vector<Signals>& experiments);

/// The same; a fit that could not be made says why (failed).
[[nodiscard]] Fit fit_again(const FittedMethod& from, const std::vector<Signals>& experiments);

/// Where the method ends when it begins near a maximum: from where `from` stands, its noise and initial states too.
[[nodiscard]] Maximisation maximise_near(const FittedMethod& from, const std::vector<Signals>& experiments);

/// Another place to begin at.
struct AnotherStart {
  std::vector<double> values;              ///< of all parameters
  std::vector<double> noise_factors = {};  ///< of the noise of every output, then of the random force; empty: 1
};

/// Where it ends when it begins there, as a new fit does: initial states and noise are looked for.
[[nodiscard]] Maximisation maximise_from(const FittedMethod& from, const AnotherStart& start, const std::vector<Signals>& experiments);

}  // namespace misfit
