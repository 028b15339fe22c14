#pragma once

// References
//   [DK] J. Durbin, S. J. Koopman, Time Series Analysis by State Space Methods (2012), 7.3: information of the innovations form.

#include <string>

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// What a measurement adds to the log-likelihood; 0 where it was not used.
[[nodiscard]] double log_density(const FilterTrace& trace, std::size_t place);

/// The penalised log-likelihood of an estimate's data at any parameters: the filter run anew, nothing fixed.
class ExactObjective {
 public:
  /// Keeps a pointer.
  explicit ExactObjective(const FilterEstimate& estimate) : estimate_(&estimate) {}

  /// −infinity where a run fails. `theta` in the order of the free parameters; `traces`, if given, one per experiment.
  [[nodiscard]] double at(const Eigen::VectorXd& theta, const FilterNoise& noise) const;
  /// The same without log prior and roughness.
  [[nodiscard]] double loglik_at(const Eigen::VectorXd& theta, const FilterNoise& noise, std::vector<FilterTrace>* traces = nullptr) const;

 private:
  const FilterEstimate* estimate_;
};

/// First derivatives of the exact objective, log prior and roughness in closed form (what a stiff roughness says of a line is a difference
/// of large numbers), the log-likelihood by central differences (to one side where the model cannot be run on the other): 1e-3 of a noise's
/// logarithm; 0.05 sigma along each principal axis of the covariance that the fixed gains give. One parameter alone, moved by a share of
/// its sigma, would be no small step where others can stand in for it: these do not go along.
struct LikelihoodDerivatives {
  Eigen::VectorXd gradient;  ///< by the free parameters, then by the logarithms of the noise
  /// Fisher information of the counted measurements over the same unknowns, nothing fixed: with innovations e and their variances S,
  /// Σ ∂e ∂e/S + ½ Σ ∂S ∂S/S² [DK]. Unlike that of the Gauss–Newton steps it knows that gains and variances move with the parameters, and
  /// that curves and noise are estimated together.
  Eigen::MatrixXd information;
  /// Per experiment, measurements (sample · ny + channel, sorted) whose log density bends by more than 0.05 under such a small change along
  /// some axis, 20 times what all measurements together should (under a change shortened to a share of it: by more than that share of 0.05,
  /// as at a kink; what is smooth bends by the square of it): there the filter's linearisation breaks, its run is as good as random, and
  /// the likelihood has kinks that no maximum can be found on.
  std::vector<std::vector<std::size_t>> nonlinear;
  /// Why they do not hold: the model cannot be run beside the estimate, or more than a tenth of all measurements is nonlinear.
  std::string failure;
};
/// With `near`, taken a short step away: half the runs, to one side only; the curvature that a difference to one side lacks is taken from
/// near's information, and nonlinear measurements are not looked for. Where the curvature differs from that information by a tenth, a slope
/// is wrong by 0.0025 per sigma.
[[nodiscard]] LikelihoodDerivatives exact_derivatives(const FilterEstimate& estimate, const Eigen::VectorXd& theta, int threads,
                                                      const LikelihoodDerivatives* near = nullptr);

/// The information over (parameters, log noise) with the parameters' priors, without the roughness (invert_with adds it). A noise parameter
/// that is at its bound, or of which the data do not even know the logarithm to one unit (the shape of something that is not there), is
/// pinned.
[[nodiscard]] Eigen::MatrixXd joint_information(const FilterEstimate& estimate, const LikelihoodDerivatives& exact);

}  // namespace misfit
