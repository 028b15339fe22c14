#pragma once

#include "misfit/discover/refit.h"

namespace misfit {

// What a refit that has found its maximum tries beside it: the whole effect, the other order of two poles, shapes that
// drift.

/// Holds the strengths of an effect that exists as a whole only (CoefficientSpec::whole) at that value, if the log-likelihood falls
/// by no more than 3.3, or a hundredth of what the effect explains (a tenth, where it was found to 2 % of the whole): from where the
/// refit has found a part of it, and from the best of its screened shapes, beside the values of the estimate without it or the study's own:
/// what was found may be a maximum of its own, from which no way leads to the whole. False: there was no time to try, so that a part that
/// was found says nothing.
[[nodiscard]] bool fix_whole_strengths(const RefitWork& work, const ScreeningResult& screening, Refit& out);

/// Where the effect's time constant and one of the system's may have changed places: the better order. Where these data hardly tell the two
/// apart, the one in which the effect is the faster, as actuators and sensors are, and the other in words. Without time the order that was
/// found stays.
void try_exchanged_poles(const RefitWork& work, Refit& out);

/// Frees the drifts of its shapes (CoefficientSpec::drift_of), if that gains what chance would once in a thousand times. False: there was
/// no time to try.
[[nodiscard]] bool free_drifts(const RefitWork& work, Refit& out);

/// A delay of half a sampling interval, or a clock that is as much behind or ahead: what an input looks like that is held between its
/// samples where the model has it straight, or the other way round. In words, in Refit::also.
void note_half_a_sample(Refit& out);

/// A whole delay of the only input of a system with one output: that output late by as much gives the same recording. In words, in
/// Refit::also, if nothing is there.
void note_output_as_late(Refit& out);

}  // namespace misfit
