#pragma once

// References
//   [G]  A. Gelman, Bayesian Analysis 1 (2006): a uniform prior of a standard deviation.
//   [KS] R. E. Kass, D. Steffey, J. Am. Statist. Assoc. 84 (1989): what estimated hyperparameters add to a covariance.
//   [FS] S. N. Wood, M. Fasiolo, Biometrics 73 (2017): generalised Fellner–Schall update of smoothing parameters by marginal likelihood.

#include <Eigen/Core>
#include <vector>

#include "misfit/inference/prior.h"

namespace misfit {

/// A Gaussian linearisation of a fit: residuals r (unweighted sum of squares), N = JᵀJ, g = Jᵀr at θ, in units where one residual's
/// variance is σ².
struct NormalEquations {
  Eigen::MatrixXd N;         ///< columns × columns
  Eigen::VectorXd g;         ///< columns
  double rss = 0.0;          ///< rᵀr
  double count = 0.0;        ///< residuals
  Eigen::VectorXd theta;     ///< columns: where it was made
  ColumnPriors prior;        ///< of the columns
  double constraints = 0.0;  ///< unknowns that N ties stiffly to a known value or to another unknown: not estimated
};

struct PenalisedFit {
  Eigen::VectorXd theta;       ///< maximum of the penalised Gaussian
  Eigen::MatrixXd covariance;  ///< inverse of N/σ² + Σ λ Ω + priors
  double sigma2 = 0.0;         ///< residual variance, rss/(count − edf)
  double edf = 0.0;            ///< effective number of parameters, tr(covariance N)/σ² without those tied
  double rss = 0.0;            ///< at theta, by the linearisation
  bool ok = false;             ///< false: the information matrix is not positive definite
};

/// N/σ² + Σ λ Ω + priors; its inverse is the covariance.
[[nodiscard]] Eigen::MatrixXd precision_of(const NormalEquations& problem, const std::vector<Penalty>& penalties, double sigma2);

/// Inverse of a symmetric positive definite matrix, solved with its diagonal scaled to one: columns of different units differ by many
/// orders of magnitude. False if it is not positive definite. `log_determinant`: of H, if asked for.
[[nodiscard]] bool invert_scaled(const Eigen::MatrixXd& H, Eigen::MatrixXd& inverse, double* log_determinant = nullptr);

/// Unknowns in the eigenvectors of each Ω: x = Q x', Ω diagonal, exactly 0 for the straight line. Between the weight of a curve that is a
/// straight line to all that the data show and the information on that line lie more digits than a double has: in the curve's coefficients
/// they mix, and λ Ω c and λ cᵀΩc of a line are rounding times a large number; here they do not.
struct PenaltyBasis {
  Eigen::MatrixXd Q;
  std::vector<Penalty> penalties;
};
[[nodiscard]] PenaltyBasis penalty_eigenbasis(Eigen::Index columns, const std::vector<Penalty>& penalties);

/// Inverse of `information` + λ Ω of all penalties (neither is rotated), computed in the basis of the eigenvectors. False as above.
[[nodiscard]] bool invert_with(const Eigen::MatrixXd& information, const PenaltyBasis& basis, Eigen::MatrixXd& inverse);

/// Maximises the marginal likelihood over the λ marked `chosen` and σ² for the linearised problem [FS], updating `penalties`. With
/// `sigma2_given` > 0 the variance is kept.
[[nodiscard]] PenalisedFit estimate_smoothing(const NormalEquations& problem, std::vector<Penalty>& penalties, double sigma2_given = 0.0);

/// [log-likelihood] By which fits of one model with different roughness are compared: the density of the measurements with the parameters
/// integrated out, by Laplace's method, log-likelihood + log prior + Σ ½ rank_k log λ_k − ½ log det N; constants left out. −infinity where
/// N is not positive definite. `here`: the parameters' information at the maximum; `objective`: log-likelihood + log prior there.
[[nodiscard]] double marginal_loglik(const NormalEquations& here, const std::vector<Penalty>& penalties, double objective);

/// The step from problem.theta to the maximum of the penalised Gaussian, residuals in units of their sigma, `covariance` as of
/// PenalisedFit. PenalisedFit::theta less problem.theta, but with all digits of a small step.
[[nodiscard]] Eigen::VectorXd newton_step(const NormalEquations& problem, const std::vector<Penalty>& penalties,
                                          const Eigen::MatrixXd& covariance);

/// Covariance of the unknowns when the λ marked `chosen` are not known but only as well as the data show them [KS]:
///   Σ_λ w(λ) [C(λ) + C(λ) E C(λ) + (θ(λ) − θ)(θ(λ) − θ)ᵀ],
/// C(λ), θ(λ): covariance and maximum at that λ, θ: the maximum at the λ that are used, E: what residuals with memory add to N (empty:
/// nothing). w: marginal likelihood of the linearised problem under a uniform prior of 1/sqrt(λ), the size of C'' [G], so that a curve that
/// is a straight line to all that the data show keeps the band of the bends they cannot exclude. One λ at a time, in steps of sqrt(10), the
/// others fixed; what each adds is summed. Without chosen λ: C + C E C.
[[nodiscard]] Eigen::MatrixXd with_uncertain_roughness(const NormalEquations& problem, const std::vector<Penalty>& penalties, double sigma2,
                                                       const Eigen::MatrixXd& excess = {});

/// The maximum of the linearised problem along the λ of one penalty, the others fixed.
struct RoughnessPoints {
  int curve = -1;                      ///< index into Model::curves
  double used = 0.0;                   ///< the penalty's own λ
  bool chosen = false;                 ///< Penalty::chosen
  std::vector<double> lambda;          ///< rising
  std::vector<Eigen::VectorXd> theta;  ///< problem.theta at `used`
  std::vector<double> log_likelihood;  ///< marginal one of the linearised problem, less that at `used`
};

/// For each λ > 0: four decades down and up in steps of a third of a decade. With P = N/σ² + Σ λ Ω + priors at the λ that were used, θ
/// their maximum: (P + (λ' − λ) Ω) θ' = P θ. Where P is not positive definite at some λ', it is left out.
[[nodiscard]] std::vector<RoughnessPoints> roughness_paths(const NormalEquations& problem, const std::vector<Penalty>& penalties,
                                                           double sigma2);

}  // namespace misfit
