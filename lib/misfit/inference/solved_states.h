#pragma once

#include <vector>

#include "misfit/data/signals.h"
#include "misfit/model/model.h"

namespace misfit {

/// States found by solving the outputs for them.
struct SolvedStates {
  std::vector<int> states;                  ///< which
  std::vector<std::vector<double>> values;  ///< of each at every sample; NaN where no solution was found
};

/// Solves the nonlinear outputs y = h(x) of a system for the states that they depend on and that are not `shown` by others: x = L sin θ and
/// y = −L cos θ for θ. Per sample: Gauss–Newton with Levenberg damping from the sample before, at the first one from a grid about each
/// state's start; with the parameters at their present values and effects off. Outputs weigh by their own spread. A solution counts if it
/// leaves less than half of that and if every state is determined. Nothing where there are more such states than outputs. Of two branches
/// (θ and π − θ from x alone) the one nearest to the sample before is taken, at first that nearest to the state's start.
[[nodiscard]] SolvedStates solve_outputs(const Model& model, const Signals& signals, const std::vector<bool>& shown);

}  // namespace misfit
