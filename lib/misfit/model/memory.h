#pragma once

#include <algorithm>

#include "misfit/model/effect.h"

namespace misfit {

/// A delay: it reads an input as it was before.
[[nodiscard]] inline bool reads_the_past(const EffectSpec& effect) {
  return std::any_of(effect.quantities.begin(), effect.quantities.end(), [](const Role& role) { return role.late_by[0] != '\0'; });
}

/// It depends on more than the present: by its own states, or a delay.
[[nodiscard]] inline bool has_memory(const EffectSpec& effect) { return !effect.states.empty() || reads_the_past(effect); }

}  // namespace misfit
