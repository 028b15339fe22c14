#pragma once

#include <vector>

#include "misfit/fit/shooting/output_error_setting.h"
#include "misfit/inference/coloured.h"

// What output error makes of a finished run: not for use outside.
namespace misfit::output_error_parts {

/// Where a search ended: the problem, one run per experiment from its initial state, and the measurements.
struct SimulatedRuns {
  const Shooting& shooting;
  const std::vector<Segment>& runs;
  const std::vector<Signals>& experiments;
};

/// Per-channel residuals of the estimation part → standard deviations, the effective number of parameters taken off the measurements, of
/// each output by its share of them. Where nothing is left, and where the noise is given, the shooting's own.
[[nodiscard]] std::vector<double> channel_sigmas(const SimulatedRuns& end, double edf);
/// Where nothing is left of a free noise: a warning.
void warn_of_unknown_noise(const SimulatedRuns& end, double edf, Fit& fit);

/// Residuals and their derivatives by (parameters, initial states of each experiment) in units of sigma, from runs with derivatives; the
/// residuals of an output whose noise is given in units of their own RMS.
[[nodiscard]] std::vector<ResidualRows> residual_rows(const SimulatedRuns& end);

/// Channels of every experiment with sigma from noise and `covariance` of (parameters, initial states of each experiment).
void predictions_of(const SimulatedRuns& end, const Eigen::MatrixXd& covariance, Fit& fit);

/// Noise of every output with its standard error from `degrees` of freedom in all, of which each has its share of the measurements.
void set_noise(const Shooting& shooting, const std::vector<Signals>& experiments, double degrees, Fit& fit);
/// Of every experiment, and where those of experiments come from whose samples are all held out.
void set_initial_states(const Shooting& shooting, const std::vector<Signals>& experiments, FittedModel& out);
/// Why no sigma is given.
[[nodiscard]] std::string too_few(double count, double unknowns);

/// Predictions of the segments of the last solve, so that a figure can show where they fail; sigma is the residuals' own.
void show_segments(Shooting& shooting, const std::vector<Signals>& experiments, Fit& fit);

/// RMS, per experiment too (record_residuals.h), and Gaussian log-likelihood of estimation and validation part, from the predictions and
/// fit.noise.
void errors_of(const std::vector<Signals>& experiments, Fit& fit);

/// Do the segments of the last solve predict every output better than a constant per experiment would, or to three sigmas of its noise? If
/// not, what the solver reached is no start for longer ones. Over all experiments together: one at rest shows nothing to be followed.
[[nodiscard]] bool segments_follow(Shooting& shooting, const std::vector<Signals>& experiments);

/// Minus the log-likelihood of the residuals with each channel's noise at its maximum, but for constants.
[[nodiscard]] double misfit_of(const SimulatedRuns& end);

/// Parameters that the information matrix does not determine (`which`, a sentence): the sentence holds for the data only at a maximum
/// (`unsettled` is empty; else says why it may be none) and if the residuals are less than half of the motion; else it is said of the point
/// where the search ended.
[[nodiscard]] std::string why_undetermined(const std::string& which, std::string unsettled, const SimulatedRuns& end);

/// Where the noise of an output is given and its residuals are of another size: a warning.
void warn_of_other_noise(const Model& model, Fit& fit);

struct MotionFacts {
  const Setting& setting;
  const std::vector<Signals>& experiments;
  double unknowns = 0.0;       ///< per channel
  std::optional<bool> driven;  ///< by the regression, where there is one: so that all methods say the same
};
/// Says whether a deterministic model followed the motion of the first output that counts, all experiments together, and marks the fit
/// where it did not.
void classify_motion(const Model& model, const MotionFacts& motion, Fit& fit);

}  // namespace misfit::output_error_parts
