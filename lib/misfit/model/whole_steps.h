#pragma once

#include <vector>

#include "misfit/model/model.h"

namespace misfit {

/// The parameter by which an effect has all measurements of its output apart (OfMeasurements::step); −1: it is of another kind.
[[nodiscard]] int step_of_measurements(const BoundEffect& effect);

/// An effect of which all measurements of an output are in whole steps, held as a whole (its strengths fixed at CoefficientSpec::whole):
/// nothing of it is estimated, so that what was read is known to lie within half a step of the measurement.
[[nodiscard]] bool reads_whole_steps(const Model& model, const BoundEffect& effect);

/// Per output, the step that its measurements are read in (reads_whole_steps()) [unit of the output], 0: they are read as they are; empty
/// where all are.
[[nodiscard]] std::vector<double> steps_of_outputs(const Model& model);

/// What a value of an output [its unit] is read as: the nearest of the steps that it is read in, counted from their level, or itself.
[[nodiscard]] double as_read(const Model& model, int output, double value);

/// The model with such effects off: what is read before it is rounded.
[[nodiscard]] Model before_whole_steps(Model model);

}  // namespace misfit
