#pragma once

#include "misfit/model/system.h"

namespace misfit {

/// d<state>/dt, which a system of equations has for every state, rather than a port that its author declared.
[[nodiscard]] inline bool is_rate_port(const PortSpec& port) { return port.name == "d" + port.conjugate + "/dt"; }

}  // namespace misfit
