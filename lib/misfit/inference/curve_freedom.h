#pragma once

#include <vector>

#include "misfit/data/fit.h"
#include "misfit/inference/roughness.h"
#include "misfit/model/model.h"

namespace misfit {

/// Effective degrees of freedom of each penalised curve, tr(C N)/σ² over its columns, with the λ of the penalties; its other priors count
/// as data. As many as it has coefficients for λ = 0, 2 for a straight line. Empty where the information is not positive definite.
[[nodiscard]] std::vector<double> curve_freedom(const NormalEquations& problem, const std::vector<Penalty>& penalties, double sigma2);

/// Writes them into Fit::facts, as freedom_fact() calls them.
void describe_freedom(const Model& model, const NormalEquations& problem, const std::vector<Penalty>& penalties, double sigma2, Fit& fit);

}  // namespace misfit
