#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/fit/filter/filter_estimate.h"
#include "misfit/fit/shooting/output_error.h"

namespace misfit {

/// A fit as others start from it: of replicas of its data, or of the same data with a parameter held. Roughness stays as it was chosen.
struct FittedMethod {
  std::string method;                                       ///< "equation_error", "output_error", "filter_error"
  FittedModel fitted;                                       ///< penalties with the weights that were chosen
  std::optional<FilterNoise> noise, around;                 ///< of filter_error
  std::optional<std::vector<std::vector<SampleRole>>> use;  ///< of filter_error: which measurements count
};

/// The method again from where the fit ended, on other data of the same model (knots are the model's). The roughness is held, sigmas are
/// those of white residuals. A fit that has not converged says so, as does one that could not be made (failed). Several threads may call it
/// at once.
[[nodiscard]] Fit fit_again(const FittedMethod& from, const std::vector<Signals>& experiments);

/// A maximum of the penalised log-likelihood, roughness held.
struct Maximisation {
  std::optional<double> objective;  ///< nullopt: the search ended nowhere …
  std::string why;                  ///< … for this reason
  FittedMethod at;                  ///< the fit's, moved to where the search ended
};

/// Where the method ends when it begins near a maximum: from where `from` stands, its noise and initial states too.
[[nodiscard]] Maximisation maximise_near(const FittedMethod& from, const std::vector<Signals>& experiments);

/// Where it ends when it begins at other values of all parameters, as a new fit does: initial states and noise are looked for.
/// Several threads may call it at once.
[[nodiscard]] Maximisation maximise_from(const FittedMethod& from, const std::vector<double>& values,
                                         const std::vector<Signals>& experiments);

/// Has the method a likelihood of the motion, and so profiles?
[[nodiscard]] bool has_likelihood(const std::string& method);

/// Why a parameter can have no profile, as "is no free parameter of the model — did you mean …"; empty if it can: it is free, and no
/// coefficient of a curve.
[[nodiscard]] std::string why_no_profile(const Model& model, const std::string& name);

/// Penalised log-likelihood at its maximum over everything but one parameter: what a profile is made of. Starts from where the last call
/// ended.
class ProfileObjective {
 public:
  /// Keeps a reference to the experiments. InputError: a method without likelihood, a parameter that can have no profile.
  ProfileObjective(FittedMethod from, const std::vector<Signals>& experiments, const std::string& parameter);
  /// nullopt where the model cannot be run, or the fit does not converge, with the parameter at `value`.
  [[nodiscard]] std::optional<double> operator()(double value);

 private:
  FittedMethod at_;
  const std::vector<Signals>* experiments_;
  std::size_t parameter_ = 0;
  double prior_mean_ = 0.0;
  std::optional<double> prior_sigma_;
};

}  // namespace misfit
