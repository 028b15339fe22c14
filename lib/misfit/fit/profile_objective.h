#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/fit/methods.h"

namespace misfit {

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
};

}  // namespace misfit
