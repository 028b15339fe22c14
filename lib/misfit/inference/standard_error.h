#pragma once

#include <optional>

#include "misfit/core/lists.h"
#include "misfit/math/covariance.h"
#include "misfit/model/model.h"

namespace misfit {

/// Of a parameter of the model; nullopt where it is fixed or `covariance`, that of the free parameters, is not known.
[[nodiscard]] inline std::optional<double> standard_error_of(const Model& model, const Eigen::MatrixXd& covariance, int parameter) {
  const int column = place_of(model.free_parameters(), parameter);
  if (column < 0 || column >= covariance.rows()) return std::nullopt;
  return standard_error(covariance, column);
}

}  // namespace misfit
