#pragma once

#include <string>
#include <vector>

#include "misfit/model/model.h"

namespace misfit {

/// Parameters to start from where a model cannot be run from those it was given, and what has been changed, in words.
struct RunnableStart {
  Model model;
  std::string words;
};

/// Free numbers that are strengths of effects of their own: all 0, and these effects add nothing.
[[nodiscard]] std::vector<int> free_strengths(const Model& model);

/// The model with every free number that is a strength of an effect at 0 (the effect adds nothing), or at the bound next to 0; what was not
/// 0 before is named in `words`.
[[nodiscard]] RunnableStart with_strengths_off(const Model& model);

/// Starts to try in this order: the damping at its typical size (the system's damping curve at minus its scale, strengths of dissipative
/// effects at their scale); strengths off; both; both with the damping curve at plus its scale; strengths off and all curves at 0; these
/// with damping. Those that differ neither from `model` nor from one before are left out.
[[nodiscard]] std::vector<RunnableStart> runnable_starts(const Model& model);

}  // namespace misfit
