#pragma once

#include <vector>

#include "misfit/data/candidates.h"
#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

/// What an effect in a fitted model adds to the system's rates, as a force F(t) on its ports: at the states x(t) smoothed from all
/// measurements,
///   dx/dt with the effect − dx/dt with its strengths at 0 = (∂(dx/dt)/∂F) F, solved for F by least squares.
/// For an effect on a dynamic port that is its own formula; for one that changes an input or another quantity, the force that does the
/// same. `strengths`: its parameters among those of estimate.model. Empty where it adds none, as an error of a sensor.
[[nodiscard]] std::vector<AddedForce> added_force_of(const FilterEstimate& estimate, const std::vector<int>& strengths);

/// Strength of the random force on each port.
[[nodiscard]] std::map<std::string, Estimate> random_force(const FilterEstimate& estimate);

}  // namespace misfit
