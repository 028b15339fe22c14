#pragma once

#include "misfit/fit/filter_estimate.h"

namespace misfit {

/// The penalised log-likelihood of an estimate's data at any parameters: the filter run anew, nothing held.
class ExactObjective {
 public:
  /// Keeps a pointer; `free`: Model::free_parameters() of the estimate's model.
  ExactObjective(const FilterEstimate& estimate, std::vector<int> free) : estimate_(&estimate), free_(std::move(free)) {}

  /// −infinity where a run fails. `theta` in the order of the free parameters; `traces`, if given, one per experiment.
  [[nodiscard]] double at(const Eigen::VectorXd& theta, const FilterNoise& noise, std::vector<FilterTrace>* traces = nullptr) const;

 private:
  const FilterEstimate* estimate_;
  std::vector<int> free_;
};

/// First derivatives of the exact objective by central differences, 0.05 sigma of a parameter and 1e-3 of a noise's logarithm to either
/// side.
struct ExactDerivatives {
  Eigen::VectorXd gradient;  ///< by the free parameters, then by the logarithms of the noise; 0 where a run beside fails
  /// Per experiment, readings (sample · ny + channel, sorted) whose log density bends by more than 0.05 under such a small change of some
  /// parameter, 20 times what all readings together should: there the filter's linearisation breaks, its run is as good as random, and the
  /// likelihood has kinks that no maximum can be found on.
  std::vector<std::vector<std::size_t>> rough;
};
[[nodiscard]] ExactDerivatives exact_derivatives(const FilterEstimate& estimate, const Eigen::VectorXd& theta, int threads);

/// log prior of the free parameters at `theta`, roughness included (constants left out).
[[nodiscard]] double log_prior_at(const Model& model, const std::vector<Penalty>& penalties, const Eigen::VectorXd& theta);

}  // namespace misfit
