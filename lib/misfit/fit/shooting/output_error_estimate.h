#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/fit/shooting/output_error_result.h"
#include "misfit/inference/roughness.h"

// What output error knows where a search ended: not for use outside.
namespace misfit::output_error_parts {

/// Normal equations, Gaussian posterior and simulated segments at the estimate.
struct LinearisedEstimate {
  NormalEquations linearised;
  PenalisedFit smoothed;
  std::vector<Segment> runs;
  [[nodiscard]] double degrees() const { return linearised.count - smoothed.edf; }
};

/// [log-likelihood] By which ends are compared: with priors and the noise of every output; where roughness is chosen, with the parameters
/// integrated out (marginal_loglik()).
[[nodiscard]] double height_of(const LinearisedEstimate& end, const SimulatedRuns& search, const std::vector<Penalty>& penalties);

/// What estimates are described with.
struct DescribedWith {
  const std::vector<ReconstructedStates>& states;
  const std::vector<Penalty>& penalties;
  bool coloured = true;  ///< allow for autocorrelated residuals
};

/// Parameters, curves and trim with the covariance of all unknowns, which is returned: allowing for autocorrelated residuals, and what
/// white ones would give beside it.
Eigen::MatrixXd describe_estimates(const LinearisedEstimate& end, const SimulatedRuns& search, const DescribedWith& with, FittedModel& out);

/// A search that has ended, for what is to be said of it.
struct EndedSearch {
  const LinearisedEstimate& end;
  SimulatedRuns runs;
  const Setting& setting;
  std::optional<bool> regression_says_driven;
  const std::vector<std::string>& other_maxima;  ///< in words
};
/// Warnings, whether the motion is followed, priors that the data contradict; sigmas are withheld where too few measurements are left.
void add_remarks(const EndedSearch& search, const Eigen::MatrixXd& covariance, FittedModel& out);

}  // namespace misfit::output_error_parts
