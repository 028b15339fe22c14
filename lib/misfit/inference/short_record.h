#pragma once

#include <string>

#include "misfit/data/fit.h"

namespace misfit {

/// Fewest degrees of freedom of which a residual variance, and with it any sigma, is worth giving.
inline constexpr double kFewestDegrees = 2.9;  // 3 but for rounding

/// Degrees of freedom below which a record is short: 95 % intervals by Student's t are wider than value ± 1.96 sigma by more than a few
/// thousandths, and correlations by lag are too noisy to be used where nothing says that there are any.
inline constexpr double kShortRecord = 500.0;

/// 95 % intervals of parameters and trim (Estimate::interval) by Student's t of the degrees of freedom. A sigma stays the standard error.
/// Where facts["covariance"] says what the sigmas are, it then says that of the intervals. None of fewer than one degree of freedom.
void add_student_intervals(double degrees, Fit& fit);

/// Takes away the sigmas of parameters, trim, noise and curves, and their covariance: not known. `why` goes into the warnings.
void withhold_sigmas(const std::string& why, Fit& fit);

}  // namespace misfit
