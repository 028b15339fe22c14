#pragma once

#include <vector>

#include "misfit/data/signals.h"
#include "misfit/math/statistics.h"
#include "misfit/model/model.h"
#include "misfit/sim/trajectory.h"

namespace misfit {

/// States and their derivatives read from the measured channels by local polynomials; what start values and regressions need.
struct ReconstructedStates {
  RowMatrix x;              ///< samples × states; start_of() for a state that no channel shows
  RowMatrix dx;             ///< samples × states: time derivative, where known
  std::vector<bool> ok;     ///< all shown states and their derivatives are known at this sample
  std::vector<bool> shown;  ///< per state: measured itself or the rate of a measured one
};

/// Quadratic least squares over five neighbouring samples, or, where fewer than four of them are there, over seven or nine (uneven times
/// and missing samples allowed; never stretched over a gap of more than five usual steps): value, slope, second derivative; of sensors
/// with clocks of their own (own_clocks.h) between their own samples (own_samples.h). A state is shown if an output observes it, if
/// System::read_states() gives it, if solve_outputs() finds it, or if it is the rate of one that is. Own states of effects are computed
/// along these (own_states_along()).
[[nodiscard]] ReconstructedStates reconstruct_states(const Model& model, const Signals& signals);

/// What a state is taken to be before anything shows it: its declared start, else one scale inside its range, else 0.
[[nodiscard]] double start_of(const StateSpec& state);

/// Own states of effects at rest where the system's states, inputs and time are `at` (values of the model's states; own states are set):
/// where their drift is 0, effect by effect, by one Newton step, which is exact for the linear memories (a lag at the level it follows).
/// Those whose drift does not tell them (play inside its clearance) stay at their declared initial value.
void set_own_states_at_rest(const Model& model, const InputsAt& u, double t, Eigen::Ref<Eigen::VectorXd> at);

/// Fills the columns of own states: the memories of effects along the motion (own_states.h).
void add_own_states(const Model& model, const Signals& signals, ReconstructedStates& states);

/// Circular frequency of the motion [rad/s]: sqrt(var(x')/var(x)) over the shown pairs of state and rate, the largest; 0 if there is none.
[[nodiscard]] double motion_frequency(const Model& model, const ReconstructedStates& states);

/// White measurement noise of a channel from its fifth differences, robustly (MAD): smooth motion at ω h < 0.3 contributes less than 0.3 %
/// of its amplitude. Of a channel that lacks so many samples that no six stand together: of those it has.
[[nodiscard]] double measurement_noise(const std::vector<double>& values);

}  // namespace misfit
