#pragma once

// References
//   [MK] E. A. Morelli, V. Klein, J. Guidance 20 (1997) 74–80; NASA TP (1995): accuracy of parameters estimated with coloured residuals.
//   [P]  D. N. Politis, J. Nonparametric Statist. 15 (2003), Econometric Theory 27 (2011): flat-top windows, made positive.

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "misfit/sim/trajectory.h"

namespace misfit {

/// Residuals of one experiment in units of their sigma, and their derivatives.
struct ResidualRows {
  RowMatrix J;        ///< (samples · channels) × columns, row = sample · channels + channel; 0 where a residual does not count
  Eigen::VectorXd r;  ///< predicted − measured; NaN where it does not count (missing, held out, excluded)
  std::vector<Eigen::Index> place;  ///< of each column of J among all unknowns
};

struct ColouredCovariance {
  Eigen::MatrixXd covariance;  ///< of all unknowns
  Eigen::MatrixXd excess;      ///< what autocorrelation adds to N: Σ = H⁻¹ + H⁻¹ excess H⁻¹
  int lags = 0;                ///< correlations up to this lag count fully, from there on less, at twice this lag not at all
  double largest_correlation = 0.0;
  int largest_lag = 0;  ///< of the largest correlation in size at lag ≥ 1
  /// Per channel Σ ρ² over all lags: the variance of a residual variance is 2 σ⁴/n times this (Bartlett). 1 for white residuals.
  Eigen::VectorXd squared_correlations;
  /// Degrees of freedom of such a variance, n/Σ w² over the lags of both signs with window w, n the residuals that count, per channel:
  /// 2/degrees is about the variance of its relative error. Infinite where the residuals were taken as white.
  double degrees = std::numeric_limits<double>::infinity();
};

/// Is whiteness of the residuals of every channel, experiments joined, not rejected at 5 %? For short records: their correlations are known
/// so poorly that a covariance that uses them is worse than the plain one where the residuals are white (95 % intervals of 50 white
/// residuals then hold the truth in 70 to 85 % of cases).
[[nodiscard]] bool residuals_are_white(const std::vector<ResidualRows>& experiments, Eigen::Index channels, double unknowns);

/// The same without the directions in which autocorrelation makes the covariance smaller (residuals that alternate): of a short record only
/// what makes it larger is used.
[[nodiscard]] ColouredCovariance widening_only(ColouredCovariance covariance, const Eigen::MatrixXd& plain);

/// The answer for white residuals: `plain`.
[[nodiscard]] ColouredCovariance white_covariance(const Eigen::MatrixXd& plain, Eigen::Index channels);

/// Covariance of a least-squares estimate whose residuals are not white [MK]:
///   Σ = H⁻¹ [Σ_ij S_iᵀ ℛ(i − j) S_j + P] H⁻¹,  H = N + P,  N = Σ S_iᵀ S_i,
/// with S the derivatives and ℛ the residuals' correlation over lags and channels, both in units of the channels' sigma. P, priors and
/// roughness, is a Gaussian prior whose share is known exactly, so that white residuals (ℛ = 1 at lag 0) give the plain H⁻¹. Initial states
/// and whatever else was estimated are columns like the others.
///
/// ℛ is estimated from the residuals, all experiments together: products by lag over pairs that both count, divided by their number; what
/// the fit has taken out of the residuals, E[v vᵀ − r rᵀ] = Πℛ + ℛΠᵀ − S Σ Sᵀ with Π = S H⁻¹ Sᵀ, is put back (six rounds; of a pair at lag
/// k with gaps the share that counts). Lags: those at which some correlation stands out of the noise, at least n^(1/3), under a flat-top
/// window; negative eigenvalues of the spectral density are set to zero, so that Σ is positive semi-definite [P]. By Fourier transforms, in
/// pieces of at most 14336 samples between which correlation is neglected: O(n log n · columns + n · columns²).
///
/// Channels whose sensors have clocks of their own (own_clocks.h) are taken each by itself, lags in its own samples (few of
/// them as in residual_covariance()); that their noise has nothing in common is then assumed.
///
/// `plain`: H⁻¹. Assumes stationary residuals and even sampling: lags are counted in samples. Does not correct the bias that random forcing
/// gives the estimates of a deterministic model.
[[nodiscard]] ColouredCovariance coloured_covariance(const std::vector<ResidualRows>& experiments, const Eigen::MatrixXd& plain,
                                                     Eigen::Index channels);

/// coloured_covariance(); for fewer `degrees` of freedom than kShortRecord white_covariance(), or where whiteness is rejected
/// widening_only().
[[nodiscard]] ColouredCovariance residual_covariance(const std::vector<ResidualRows>& experiments, const Eigen::MatrixXd& plain,
                                                     Eigen::Index channels, double degrees);

/// What was done, for a reader: "allows for autocorrelated residuals (…): correlations up to lag 24 samples count, the largest
/// is -0.61 at lag 3; …".
[[nodiscard]] std::string in_words(const ColouredCovariance& covariance);

}  // namespace misfit
