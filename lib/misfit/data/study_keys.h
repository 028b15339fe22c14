#pragma once

#include <span>

#include "misfit/core/keys.h"

namespace misfit {

/// What an input may be between its samples: names of Hold.
[[nodiscard]] std::vector<std::string> hold_names();

/// Every key of study.toml, in the order of the reference (misfit help study): names, types, units, defaults, limits, meaning.
[[nodiscard]] std::span<const config::KeyGroup> study_keys();

/// A parameter that a declared effect or system brings: { unit, value, bounds, … }.
[[nodiscard]] std::vector<config::Key> declared_parameter_keys(bool free);

}  // namespace misfit
