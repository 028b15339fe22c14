#pragma once

// References
//   [W]  G. Wahba, J. R. Statist. Soc. B 40 (1978): a roughness penalty is a Gaussian prior with C'' white noise.

#include <Eigen/Core>
#include <vector>

#include "misfit/model/model.h"

namespace misfit {

/// Independent Gaussians, one per unknown: precision 1/sigma² [1/unit²] and mean [unit]; precision 0: none.
struct ColumnPriors {
  Eigen::VectorXd precision, mean;

  [[nodiscard]] double log_density(const Eigen::VectorXd& theta) const;  ///< −½ Σ precision (theta − mean)²
  [[nodiscard]] Eigen::VectorXd gradient(const Eigen::VectorXd& theta) const;
  /// With further unknowns behind, of which nothing is known.
  [[nodiscard]] ColumnPriors padded(Eigen::Index unknowns) const;
};

/// The priors of the free parameters (Parameter::prior_sigma about prior_mean; of a curve: each of its coefficients), in the order of
/// Model::free_parameters().
[[nodiscard]] ColumnPriors parameter_priors(const Model& model);

/// The same with a very wide one about 0 for parameters that have none: keeps linear algebra regular where a coefficient is touched by no
/// sample. Its sigma is 1000 typical sizes. A typical size in SI may be a guess, though, 1 N/m^3 where a spring has 1e7: where that prior
/// would have more than a hundredth of the precision with which the measurements alone know the parameter, `information` (the diagonal of
/// their information matrix, which may go on behind the free parameters), it has a millionth of it. Not so for curves, nor for parameters
/// of which the measurements know less than 1e9 typical sizes. Part of no objective.
[[nodiscard]] ColumnPriors regularised_priors(const Model& model, const Eigen::VectorXd& information);

/// Of the free parameters without a stated prior, those of which the very wide one of regularised_priors() knows more than the
/// measurements, so that `covariance` (of the free parameters) says nothing of them. Curves aside. `information` as there.
[[nodiscard]] std::vector<int> left_to_wide_priors(const Model& model, const Eigen::VectorXd& information,
                                                   const Eigen::MatrixXd& covariance);

/// log density of one parameter's prior at its value, constants left out; 0 if it has none.
[[nodiscard]] double log_prior(const Parameter& parameter);

/// Quadratic penalty λ ∫ C''² = λ cᵀ Ω c of one curve whose coefficients are all free, in the units of −2 log density: C'' is a priori
/// white noise of intensity 1/λ [W]. The unit of λ is argument³/value²; it does not depend on the measurement noise.
struct Penalty {
  int curve = -1;         ///< index into Model::curves
  int first = 0;          ///< first column
  Eigen::MatrixXd omega;  ///< size × size
  int rank = 0;           ///< size − 2: straight lines are free
  double lambda = 0.0;
  bool chosen = false;  ///< true: λ is to be chosen from the data

  /// ½ rank log λ: what the normalised log density counts besides −½ λ cᵀΩc where λ is not given; constants left out.
  [[nodiscard]] double log_normalisation() const;
};

/// Penalties of the model's free curves; columns are those of Model::free_parameters(). Where the study gives no roughness λ starts at
/// `scale`-based size: a curve whose slope turns by its typical size over its whole range.
[[nodiscard]] std::vector<Penalty> curve_penalties(const Model& model);

/// The curves' roughness as it was chosen, so that any method keeps it.
[[nodiscard]] Model with_roughness(Model model, const std::vector<Penalty>& penalties);

/// The prior of all unknowns, for every method and diagnosis:
///   log p(θ) = −½ Σ_i p_i (θ_i − m_i)² − ½ Σ_k λ_k c_kᵀ Ω_k c_k + constant.
/// `columns` may be longer than the free parameters (initial states, noise), which come first.
struct GaussianPrior {
  ColumnPriors columns;
  std::vector<Penalty> penalties;

  [[nodiscard]] double log_density(const Eigen::VectorXd& theta) const;        ///< constant left out
  [[nodiscard]] Eigen::VectorXd gradient(const Eigen::VectorXd& theta) const;  ///< of log_density
  /// Adds minus the second derivatives of log_density to an information matrix.
  void add_precision(Eigen::MatrixXd& information) const;
};

/// regularised_priors() for a step from the point `at`: about that point, so that the steps end at the maximum of the objective; but about
/// 0 in the directions whose precision comes for more than half from the very wide prior, beside measurements, stated priors and roughness:
/// what nothing determines does not drift. `information`: of the measurements, which may go on behind the free parameters.
[[nodiscard]] ColumnPriors regularised_priors_about(const Eigen::VectorXd& at, const Model& model, const std::vector<Penalty>& penalties,
                                                    const Eigen::MatrixXd& information);

/// Is a roughness weight among what is estimated?
[[nodiscard]] bool any_chosen(const std::vector<Penalty>& penalties);
/// The same weights, not to be estimated.
[[nodiscard]] std::vector<Penalty> with_fixed_weights(std::vector<Penalty> penalties);

/// log density of the model's free parameters at their present values.
[[nodiscard]] double log_prior(const Model& model, const std::vector<Penalty>& penalties);

/// A residual block L (θ[first …] − mean) of −log p = ½ Σ |residual|², for a least-squares solver.
struct PriorRows {
  int first = 0;
  Eigen::MatrixXd L;
  Eigen::VectorXd mean;
};
[[nodiscard]] std::vector<PriorRows> prior_rows(const GaussianPrior& prior);

}  // namespace misfit
