#pragma once

#include <optional>
#include <string>

#include "misfit/model/model.h"

namespace misfit {

/// "tau = 62 s is longer than half of the recording, 40 s" where a time of an effect of the model, which remembers, is: on such a record a
/// lag is a constant force and a stiffness. So where its frequency makes less than one period: a drift. nullopt: none is.
[[nodiscard]] std::optional<std::string> outlasts_recording(const Model& model, const BoundEffect& effect, double seconds);

}  // namespace misfit
