#include "misfit/calibrate/outliers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/math/statistics.h"

namespace misfit {
namespace {

std::vector<double> all_residuals(const std::vector<SweepPoint>& points, double l_b, const CameraParameters<double>& camera) {
  std::vector<double> residuals;
  for (const SweepPoint& p : points) {
    const auto predicted = predict(p, l_b, camera);
    for (const double r : {p.P_y - predicted[0], p.P_z - predicted[1]}) {
      if (std::isfinite(r)) residuals.push_back(r);
    }
  }
  return residuals;
}

// About zero, not about the median: a common shift is an error of the camera, not its noise.
double robust_sigma(const std::vector<double>& residuals, std::size_t free) {
  std::vector<double> both = residuals;
  for (const double r : residuals) both.push_back(-r);
  const auto n = static_cast<double>(residuals.size());
  return mad_sigma(both) * std::sqrt(n / std::max(1.0, n - static_cast<double>(free)));
}

}  // namespace

std::vector<bool> points_within(const std::vector<SweepPoint>& points, double l_b, const SweepFit& fit, double limit) {
  // Exact data have a robust sigma of rounding errors only; 1e-6 px is far below any measurement.
  const double width = limit * std::max(1e-6, robust_sigma(all_residuals(points, l_b, fit.camera), fit.free.size()));
  std::vector<bool> keep;
  for (const SweepPoint& p : points) {
    const auto predicted = predict(p, l_b, fit.camera);
    keep.push_back(!(std::abs(p.P_y - predicted[0]) > width) && !(std::abs(p.P_z - predicted[1]) > width));  // a missing one does not count
  }
  return keep;
}

SweepFit robust_fit(const std::vector<SweepPoint>& points, double l_b, const SweepModel& model) {
  const std::vector<bool> all(points.size(), true);
  SweepModel next = model;
  next.start = start_camera(points, l_b, model.start);
  SweepFit fit;
  double scale = robust_sigma(all_residuals(points, l_b, next.start), 2);
  for (int round = 0; round < 20; ++round) {
    fit = fit_sweep({points, all, l_b}, next, {LeastSquares::Loss::cauchy, 2.0 * std::max(1e-6, scale)});
    next.start = fit.camera;
    const double previous = scale;
    scale = robust_sigma(all_residuals(points, l_b, fit.camera), model.free.size());
    if (std::abs(scale - previous) < 1e-3 * previous) break;
  }
  return fit;
}

}  // namespace misfit
