#pragma once

#include <string>
#include <vector>

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// Of the model's last effect: its coefficients that are the drift of another one (CoefficientSpec::drift_of) and are fixed at 0.
[[nodiscard]] std::vector<int> fixed_drifts(const Model& model);

/// "its shedding_frequency drifts by (6.0 ± 0.2)e-4 Hz/s", of a change along a quantity "its slope changes by 0.09 1/K", for those of
/// the model's last effect that are free; empty if none is.
[[nodiscard]] std::string drifts_in_words(const Model& model, const Eigen::MatrixXd& covariance);

}  // namespace misfit
