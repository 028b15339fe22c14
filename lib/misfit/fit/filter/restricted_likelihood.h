#pragma once

// References
//   [PT] H. D. Patterson, R. Thompson, Biometrika 58 (1971): restricted likelihood.
//   [H]  D. A. Harville, J. Amer. Statist. Assoc. 72 (1977): its derivatives.

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// What the free parameters' being estimated costs the noise's likelihood. Maximum likelihood of the noise takes for no noise what the
/// curves followed of it; a density over the parameters integrated instead of maximised does not [PT]: log-likelihood − ½ log det N(φ),
/// with φ the logarithms of the noise and N the parameters' information (gains fixed) with roughness and priors. For measurements that are
/// independent that is n − p in place of n under the sum of squares.
struct RestrictedLikelihood {
  Eigen::VectorXd slope;  ///< of −½ log det N by φ: −½ tr(N⁻¹ ∂N/∂φᵢ)
  /// By how much the noise's Fisher information is less than with known parameters: ½ tr(N⁻¹ ∂N/∂φᵢ N⁻¹ ∂N/∂φⱼ). Exact where the noise's
  /// covariance has the parameters' columns as its eigenvectors (a common factor of it, independent measurements) [H], else an
  /// approximation.
  Eigen::MatrixXd information_loss;
};

/// By differences of 1e-3 of the logarithms, to one side; zero for those at a bound and for a model without free parameters, and where the
/// model cannot be run with the changed noise or N cannot be inverted. The answer does not depend on `threads`.
[[nodiscard]] RestrictedLikelihood restricted_likelihood(const FilterEstimate& estimate, const Eigen::VectorXd& theta, int threads);

}  // namespace misfit
