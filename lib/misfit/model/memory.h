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

/// Has it own states whose rates are linear in them, as those of lags, in its examples? Not where it only adds up.
[[nodiscard]] bool has_linear_memory(const Effect& effect);

/// Has it own states whose rates depend on none of them, in all its examples: it adds up what it reads, as an angle turned does?
[[nodiscard]] bool only_adds_up(const Effect& effect);

}  // namespace misfit
