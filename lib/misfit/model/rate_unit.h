#pragma once

#include <string>

namespace misfit {

/// The unit is one per time: rad/s, m/s, kg/s, m^3/s, Hz, but neither m/s^2 nor V. InputError: it is no unit.
[[nodiscard]] bool is_per_time(const std::string& unit);

}  // namespace misfit
