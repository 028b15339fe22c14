#pragma once

// References
//   [KM]  V. Klein, E. A. Morelli, Aircraft System Identification (2006), ch. 6: output error.
//   [B]   H. G. Bock (1983): multiple shooting.

#include <vector>

#include "misfit/data/signals.h"
#include "misfit/inference/fitted_model.h"

namespace misfit {

/// Where output error begins.
struct OutputErrorStart {
  bool from_regression =
      true;                ///< the parameters are an equation-error fit; false: they are just some values, begin with very short segments
  double frequency = 0.0;  ///< fastest motion [rad/s]; 0: from the data
  bool keep_roughness = false;  ///< the start's penalties hold and its noise is begun with: for refits of nearly the same data
  /// False: for fits by the thousand whose scatter is looked at. Sigmas are then those of white residuals and known roughness, the
  /// integration is not checked at the estimate, no other weighting of the outputs and no second start is tried, and no Newton steps follow
  /// the search.
  bool thorough = true;
};

/// The whole trajectory of a deterministic model against the measured channels, by multiple shooting in Ceres (lib/misfit/README.md, 5.4):
/// first segments at most half a period of the fastest motion, defects at ten times the measurement weight, then lengthened to one
/// trajectory. Noise: white, one sigma per channel, estimated. Curves: roughness by marginal likelihood unless given. Covariance: inverse
/// of the information at the optimum, roughness and priors included, with what residuals with memory (coloured.h) and roughness chosen from
/// the data (with_uncertain_roughness()) add; that of white residuals stands beside. A start with initial states is taken as nearly there:
/// one trajectory at once, segments only if that fails. Status: converged; not_converged (iteration limit); failed (the motion cannot be
/// simulated, with time and place); declined when the motion is driven by something the model does not have: then the curves are kept but
/// marked not informative. Never throws for numerical reasons.
[[nodiscard]] FittedModel output_error(const FittedModel& start, const std::vector<Signals>& experiments,
                                       const OutputErrorStart& options = {});

}  // namespace misfit
