#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <vector>

#include "misfit/model/evaluator.h"

namespace misfit::testing_models {

/// Step for central differences of fourth order: small against `size`, never below what double precision carries.
inline double difference_step(double at) { return 1e-4 * std::max(std::abs(at), 1e-2); }

/// d f/d(at) by the five-point central difference.
inline Eigen::VectorXd central_difference(const std::function<Eigen::VectorXd(double)>& f, double at) {
  const double h = difference_step(at);
  return (8.0 * (f(at + h) - f(at - h)) - (f(at + 2 * h) - f(at - 2 * h))) / (12.0 * h);
}

/// Derivative rows with slots → rows × (states + columns) in the order of columns.
inline Eigen::MatrixXd dense(const std::vector<double>& D, int rows, int states, const Slots& slots, int columns) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, states + columns);
  for (int i = 0; i < rows; ++i) {
    const double* row = D.data() + static_cast<std::ptrdiff_t>(i) * kRowStride;
    for (int j = 0; j < states; ++j) out(i, j) = row[j];
    for (int s = 0; s < slots.count(); ++s) out(i, states + slots.column(s)) = row[states + s];
  }
  return out;
}

}  // namespace misfit::testing_models
