#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "misfit/data/signals.h"
#include "misfit/inference/fitted_model.h"

namespace misfit {

/// Where the methods that follow the motion (output_error, filter_error) begin.
struct TrajectoryStart {
  FittedModel from;
  bool regressed = false;  ///< the regression gave it; false: the values are those of the study
};

/// Equation error with every free shape (a clock angle, a frequency) fixed where the study puts it: linear, so that no start is lost in a
/// valley of another shape. The parameters are then as free as in `asked`. Of a regression on driven motion only the static curve means
/// something (lib/misfit/README.md, 5.2): its damping curve, where free, starts at 0. `whole`: gives equation_error() of the same where
/// somebody has it; called only where no shape is free.
[[nodiscard]] TrajectoryStart trajectory_start(const Model& asked, const std::vector<Signals>& experiments,
                                               const std::function<const FittedModel&()>& whole = {});

/// The same with the strengths of effects, too, fixed where the study puts them, which is off where it does not say: what the regression
/// makes of an effect can be far from what the motion says of it. nullopt: the model has no effect with such a number that is free.
[[nodiscard]] std::optional<TrajectoryStart> trajectory_start_as_given(const Model& asked, const std::vector<Signals>& experiments);

}  // namespace misfit
