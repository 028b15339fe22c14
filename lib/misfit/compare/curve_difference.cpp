#include "misfit/compare/curve_difference.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace misfit {
namespace {

bool visited(const CurveEstimate& curve, std::size_t i) { return curve.count[i] > 0.0 && std::isfinite(curve.value[i]); }

double finite_or_zero(double sigma) { return std::isfinite(sigma) ? sigma : 0.0; }

}  // namespace

std::optional<CurveValue> visited_point(const CurveEstimate& curve, double x) {
  const auto above = std::lower_bound(curve.x.begin(), curve.x.end(), x);
  if (above == curve.x.end()) return std::nullopt;
  const std::size_t k = above - curve.x.begin();
  if (!visited(curve, k)) return std::nullopt;
  if (curve.x[k] == x) return CurveValue{x, curve.value[k], finite_or_zero(curve.sigma[k])};
  if (k == 0 || !visited(curve, k - 1)) return std::nullopt;
  const double w = (x - curve.x[k - 1]) / (curve.x[k] - curve.x[k - 1]);
  const auto mix = [&](const std::vector<double>& v) { return (1.0 - w) * v[k - 1] + w * v[k]; };
  return CurveValue{x, mix(curve.value), finite_or_zero(mix(curve.sigma))};
}

std::vector<CurveValue> visited_points(const CurveEstimate& curve) {
  std::vector<CurveValue> points;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (visited(curve, i)) points.push_back({curve.x[i], curve.value[i], finite_or_zero(curve.sigma[i])});
  }
  return points;
}

std::optional<Estimate> slope_at(const CurveEstimate& curve, double x) {
  const std::vector<CurveValue> points = visited_points(curve);
  if (points.size() < 3) return std::nullopt;
  const double range = points.back().x - points.front().x;
  const double h = std::max(range / 20.0, range / static_cast<double>(points.size() - 1));
  const std::optional<CurveValue> below = visited_point(curve, x - h);
  const std::optional<CurveValue> above = visited_point(curve, x + h);
  if (!below || !above) return std::nullopt;
  const std::string unit = (curve.unit == "-" || curve.unit.empty() ? "1" : curve.unit) + "/" + curve.of_unit;
  return Estimate{(above->value - below->value) / (2.0 * h), std::hypot(above->sigma, below->sigma) / (2.0 * h), unit};
}

std::optional<CurveDifference> difference(const CurveEstimate& curve, const std::vector<CurveValue>& points) {
  CurveDifference d;
  d.curve = curve.name;
  d.of = curve.of;
  d.of_unit = curve.of_unit;
  d.unit = curve.unit;
  double sum = 0.0;
  for (const CurveValue& point : points) {
    const std::optional<CurveValue> here = visited_point(curve, point.x);
    const double sigma = here ? std::hypot(here->sigma, point.sigma) : 0.0;
    if (!(sigma > 0.0)) continue;
    const double gap = here->value - point.value;
    sum += gap * gap / (sigma * sigma);
    if (d.points == 0) d.from = point.x;
    d.to = point.x;
    if (d.points++ == 0 || std::abs(gap) / sigma > d.max_sigmas) {
      d.max_sigmas = std::abs(gap) / sigma;
      d.at = point.x;
      d.difference = {gap, sigma, curve.unit};
    }
  }
  if (d.points < 2) return std::nullopt;
  d.rms_sigmas = std::sqrt(sum / static_cast<double>(d.points));
  return d;
}

}  // namespace misfit
