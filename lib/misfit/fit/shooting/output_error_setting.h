#pragma once

#include <vector>

#include "misfit/fit/shooting/output_error.h"
#include "misfit/fit/shooting/shooting.h"
#include "misfit/inference/states.h"

// What output error looks at before it starts: not for use outside.
namespace misfit::output_error_parts {

/// Everything a fit needs that does not change while it runs.
struct Setting {
  double step = 0.0;        ///< usual sample interval [s]
  double frequency = 0.0;   ///< [rad/s]
  std::size_t samples = 0;  ///< of the longest experiment
  std::vector<double> sigma, state_scale;
  std::vector<ReconstructedStates> states;
};

[[nodiscard]] Setting setting_of(const Model& model, const std::vector<Signals>& experiments, const OutputErrorStart& options);

/// The noise of an earlier fit instead of a first guess.
[[nodiscard]] Setting with_noise(const FittedModel& start, Setting setting);

/// States at every sample to begin with: read from the measurement, gaps bridged linearly between the known neighbours.
[[nodiscard]] std::vector<RowMatrix> start_states(const Setting& setting);

/// The short segments to begin with; the last is half a period of the motion.
[[nodiscard]] std::vector<ShootingPass> short_passes(const Setting& setting, bool from_regression);

}  // namespace misfit::output_error_parts
