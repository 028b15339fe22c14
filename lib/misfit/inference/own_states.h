#pragma once

#include <Eigen/Core>

#include "misfit/inference/states.h"

namespace misfit {

/// Own states of effects (the memories of lags and delays) along the motion that the channels show, one column per own state.
struct OwnStates {
  RowMatrix z;            ///< samples × own states
  Eigen::VectorXd start;  ///< at the first sample whose states are known
  Eigen::VectorXd sigma;  ///< how uncertain they are there, if the system's states are as read
  /// own × system states: by how much `start` moves with a state that no channel shows (which is as uncertain as it is large); else 0.
  Eigen::MatrixXd by_hidden_states;
};

/// A recording begins in the middle of a motion, and a memory then holds what was before it: neither 0 nor the level that it would reach at
/// rest (a delay of 0.13 s of a pendulum that swings by 15 deg begins 40 deg wrong if its rate is taken to be 0). Where an effect's own
/// dynamics are linear with constant coefficients, z' = A z + b(x, u), its memory is computed along the states read from the channels:
///   rest r = -A^-1 b, departure d = z - r, d' = A d - r' with r' constant between samples (exact for A),
/// begun at rest; what is remembered of that beginning is left out (three times the slowest time constant, half of the recording at most),
/// as are held-out samples. The departure at the first sample is the least-squares prediction from states, their derivatives and inputs
/// there, learnt from the other samples; its sigma is the RMS of all departures, since it was computed with the effect's parameters as they
/// are now. What the memory follows may depend on a state that no channel shows, whose start is not known: dr/dx = -A^-1 db/dx.
/// Memories that are not linear (a limited rate, play inside its clearance) are integrated along the same states; that of the first sample
/// is the least-squares prediction, too, learnt from the later half of the recording, as uncertain as it errs there at most, within
/// what it visits. What only adds up (z' does not depend on z: an angle turned) begins where its effect says, and is known there. Forces
/// are at rest (set_own_states_at_rest()) and taken as known. Of `states` only those of the system are read.
[[nodiscard]] OwnStates own_states_along(const Model& model, const Signals& signals, const ReconstructedStates& states);

}  // namespace misfit
