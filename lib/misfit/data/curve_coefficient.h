#pragma once

#include <string>

namespace misfit {

/// Is a parameter of a fit a coefficient of a curve, as C_m[3]? It means something together with the others only.
[[nodiscard]] inline bool is_curve_coefficient(const std::string& parameter) { return parameter.find('[') != std::string::npos; }

/// The fact of a fit (Fit::facts) that says how many numbers of a smoothed curve the data determine.
[[nodiscard]] inline std::string freedom_fact(const std::string& curve) { return "effective degrees of freedom of " + curve; }

}  // namespace misfit
