#pragma once

#include <string>

namespace misfit {

/// Is a parameter of a fit a coefficient of a curve, as C_m[3]? It means something together with the others only.
[[nodiscard]] inline bool is_curve_coefficient(const std::string& parameter) { return parameter.find('[') != std::string::npos; }

}  // namespace misfit
