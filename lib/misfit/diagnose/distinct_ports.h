#pragma once

#include <vector>

#include "misfit/diagnose/score.h"

namespace misfit {

/// Per dynamic port the one at which what acts there is sought: itself, but for a port d<state>/dt on which a force does everywhere the
/// same as a constant multiple of it on a port that the system's author declared. With w = "(u - b*w + cable)/J" the moment `cable` is J
/// dw/dt: whatever is found on one is found on the other, and the author's name and unit are what he knows.
[[nodiscard]] std::vector<int> sought_at(const SystemSpec& system, const ForceSensitivity& force);

/// Those that are sought at themselves.
[[nodiscard]] std::vector<int> distinct_ports(const SystemSpec& system, const ForceSensitivity& force);

}  // namespace misfit
