#pragma once

#include <string>
#include <vector>

#include "misfit/model/model.h"

namespace misfit {

/// Sets the coefficients of a curve to the least-squares spline through tabulated points (x in the SI unit of its quantity); a vanishing
/// roughness keeps coefficients that no point touches on a smooth continuation. Returns the largest distance of curve and points inside the
/// knots. RunError with fewer than two points inside the knots.
double set_curve(Model& model, const std::string& name, const std::vector<double>& x, const std::vector<double>& value);

}  // namespace misfit
