#pragma once

#include <memory>

#include "misfit/data/study.h"
#include "misfit/model/effect.h"
#include "misfit/model/system.h"

namespace misfit {

/// An effect that a study declares as a formula added to a port of the system (EffectStudy::declared). The formula reads quantities,
/// predicted outputs (on sensor ports), parameters of the system, t, and coefficients of its own from `parameters`. Strengths are those the
/// study names, else the coefficients in which the formula is linear and without which it is 0, else all those in which it is linear,
/// provided that it is 0 without them; the rest are shapes. InputError with place where a name is unknown or units do not match.
[[nodiscard]] std::unique_ptr<Effect> declared_effect(const EffectStudy& study, const SystemSpec& system);

}  // namespace misfit
