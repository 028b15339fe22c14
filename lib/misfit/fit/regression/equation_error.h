#pragma once

// References
//   [P]   the paper (lib/misfit/README.md, [1]), Eqs. 8-11: regression of measured accelerations.
//   [KM]  V. Klein, E. A. Morelli, Aircraft System Identification (2006), ch. 5: equation error.

#include <vector>

#include "misfit/data/fit.h"
#include "misfit/data/signals.h"
#include "misfit/inference/fitted_model.h"
#include "misfit/model/model.h"

namespace misfit {

/// Regression of state derivatives read from the measurement on the model's right-hand side, linear in strengths and curve coefficients;
/// curves have their own roughness chosen by marginal likelihood [KM; P with B-splines instead of bins]. Noise in the measured states
/// biases it towards small damping. Samples next to the step of an input that is held between its samples are left out, unless it steps at
/// nearly every one: then a warning says that the parameters are biased. Bounds hold as in the other methods (math/bounded.h); not
/// converged where a shape still moves by 0.01 sigma after 12 rounds. The residuals of neighbouring samples share stencils: its sigmas
/// allow for that (coloured.h). On driven motion its damping is not informative: Σ α'' α' telescopes (lib/misfit/README.md, 5.2). It gives
/// starts. Declines (status, message) where the system's states cannot be read from the channels.
[[nodiscard]] FittedModel equation_error(const Model& model, const std::vector<Signals>& experiments);

}  // namespace misfit
