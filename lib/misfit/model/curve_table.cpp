#include "misfit/model/curve_table.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

double value_at(const Model& model, const Curve& curve, double x) {
  const CurvePoint point = curve.spline.at(x);
  double value = 0.0;
  for (int j = 0; j < 4; ++j) value += point.w[j] * model.parameters[curve.first + point.first + j].value;
  return value;
}

}  // namespace

double set_curve(Model& model, const std::string& name, const std::vector<double>& x, const std::vector<double>& value) {
  const Curve* curve = model.find_curve(name);
  if (curve == nullptr) throw InputError("the model has no curve '" + shown(name) + "'");
  const int size = curve->spline.size();
  Eigen::MatrixXd N = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
  int inside = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(value[i]) || x[i] < curve->spline.lowest() || x[i] > curve->spline.highest()) continue;
    const CurvePoint point = curve->spline.at(x[i]);
    for (int j = 0; j < 4; ++j) {
      const int row = point.first + j;
      b[row] += point.w[j] * value[i];
      for (int k = 0; k < 4; ++k) N(row, point.first + k) += point.w[j] * point.w[k];
    }
    ++inside;
  }
  if (inside < 2) throw RunError("curve " + name + ": fewer than two points of its table lie inside its knots");
  const Eigen::MatrixXd omega = curve->spline.roughness();
  constexpr double relative_regularisation = 1e-9;
  N += relative_regularisation * (N.trace() / omega.trace()) * omega;
  N.diagonal().array() += 1e-14 * N.trace();
  const Eigen::VectorXd c = symmetric_solve(N, b);
  for (int j = 0; j < size; ++j) model.parameters[curve->first + j].value = c[j];
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isfinite(value[i]) && x[i] >= curve->spline.lowest() && x[i] <= curve->spline.highest())
      worst = std::max(worst, std::abs(value_at(model, *curve, x[i]) - value[i]));
  }
  return worst;
}

}  // namespace misfit
