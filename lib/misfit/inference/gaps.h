#pragma once

#include <string>
#include <vector>

#include "misfit/data/signals.h"
#include "misfit/model/model.h"

namespace misfit {

/// A recording in pieces that are each one motion: cut where the time between two samples is more than 10 usual steps and more than 50
/// times as long as the fastest motion takes for a radian, 100 sub-steps of the integrator, a tenth of the most that it makes: beyond,
/// nothing of the state before is left, or the run cannot be trusted. Shorter gaps are bridged by the model. Fastest: the larger of the
/// model's rate at its present parameters and of what the channels show, rms(x')/sd(x) without the measurement noise's share.
/// Cut as well where rows are missing and an input of the model with them: at a gap more than three times as long as the step that 98 % of
/// the steps do not exceed, if within such a time the input changes by more than a tenth of its standard deviation (RMS over the
/// recording). The model cannot be run across what nobody knows, and a force that is not there would be found.
/// Every piece after the first has initial states of its own (Signals::after_gap) and the name NAME_part_K; its notes say where and why it
/// was cut. Pieces of fewer than 5 samples, which show no state, are left out and counted in the notes. One piece: the recording as it is.
[[nodiscard]] std::vector<Signals> split_at_gaps(const Model& model, Signals signals);

/// Is it the recording of this experiment, or a part of it?
[[nodiscard]] bool is_part_of(const Signals& signals, const std::string& experiment);

}  // namespace misfit
