#pragma once

#include <Eigen/Core>
#include <vector>

#include "misfit/data/fit.h"
#include "misfit/inference/roughness.h"
#include "misfit/model/model.h"

namespace misfit {

/// A fit together with the model that carries its parameters, to start another method or to simulate.
struct FittedModel {
  Fit fit;
  Model model;
  std::vector<Penalty> penalties;               ///< with the roughness weights that were chosen
  std::vector<Eigen::VectorXd> initial_states;  ///< per experiment, at its first sample; empty where the method has none
  Eigen::MatrixXd plain_covariance{};           ///< of the free parameters as if residuals were white; empty where not computed
  /// Of a regression: experiment, equation, sample → what the model says of the rate less what was measured; NaN where not used.
  std::vector<std::vector<std::vector<double>>> equation_residuals{};
  double integration = 0.0;  ///< tolerance of the plan that it was integrated with (IntegrationPlan), to go on with; 0: none
};

}  // namespace misfit
