#include "misfit/inference/own_samples.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "misfit/core/lists.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

/// Points within `reach` usual steps.
LocalFit quadratic_within(const Series& series, std::size_t i, std::size_t reach) {
  const auto& [t, y, h] = series;
  Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  int points = 0;
  bool before = false, after = false;
  const std::size_t from = i >= reach ? i - reach : 0, to = std::min(i + reach, t.size() - 1);
  for (std::size_t k = from; k <= to; ++k) {
    const double s = (t[k] - t[i]) / h;
    if (!std::isfinite(y[k]) || std::abs(s) > static_cast<double>(reach) + 1.0) continue;
    const Eigen::Vector3d a(1.0, s, s * s);
    N += a * a.transpose();
    b += a * y[k];
    ++points;
    before = before || k < i;
    after = after || k > i;
  }
  if (points < 4 || !before || !after) return {};
  const Eigen::Vector3d c = N.ldlt().solve(b);
  return {c[0], c[1] / h, 2.0 * c[2] / (h * h), true};
}

/// The same parabola a time `by` later.
LocalFit moved(const LocalFit& fit, double by) {
  return {fit.value + by * (fit.slope + 0.5 * by * fit.curvature), fit.slope + by * fit.curvature, fit.curvature, fit.ok};
}

}  // namespace

LocalFit local_quadratic(const Series& series, std::size_t i) {
  constexpr std::size_t usual = 2, farthest = 4;
  for (std::size_t reach = usual; reach <= farthest; ++reach) {
    const LocalFit fit = quadratic_within(series, i, reach);
    if (fit.ok) return fit;
  }
  return {};
}

OwnSamples::OwnSamples(const std::vector<double>& t, const std::vector<double>& y) {
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!std::isfinite(y[i])) continue;
    t_.push_back(t[i]);
    y_.push_back(y[i]);
  }
  if (t_.size() > 1) h_ = usual_step(t_);
  for (std::size_t k = 0; k < t_.size(); ++k) fits_.push_back(local_quadratic({t_, y_, h_}, k));
}

LocalFit OwnSamples::at(double time) const {
  constexpr double longest = 5.0;  // usual steps
  const auto next = std::upper_bound(t_.begin(), t_.end(), time);
  if (next == t_.begin()) return {};
  const auto k = static_cast<std::size_t>(next - t_.begin()) - 1;
  if (t_[k] == time) return fits_[k];
  if (k + 1 == t_.size() || !fits_[k].ok || !fits_[k + 1].ok || t_[k + 1] - t_[k] > longest * h_) return {};
  const double s = (time - t_[k]) / (t_[k + 1] - t_[k]);
  const LocalFit before = moved(fits_[k], time - t_[k]), after = moved(fits_[k + 1], time - t_[k + 1]);
  const auto between = [s](double a, double b) { return a + s * (b - a); };
  return {.value = between(before.value, after.value),
          .slope = between(before.slope, after.slope),
          .curvature = between(before.curvature, after.curvature),
          .ok = true};
}

DensestRows at_densest(const Signals& signals) {
  const auto densest = std::max_element(signals.measured.begin(), signals.measured.end(),
                                        [](const Signal& a, const Signal& b) { return count_finite(a.values) < count_finite(b.values); });
  DensestRows out;
  for (std::size_t i = 0; i < signals.samples(); ++i) {
    if (std::isfinite(densest->values[i])) out.rows.push_back(i);
  }
  out.signals.name = signals.name;
  for (const std::size_t row : out.rows) out.signals.t.push_back(signals.t[row]);
  for (const Signal& channel : signals.measured) {
    const OwnSamples own(signals.t, channel.values);
    out.signals.measured.push_back({channel.name, channel.unit, {}, channel.sigma});
    for (const double t : out.signals.t) {
      const LocalFit fit = own.at(t);
      out.signals.measured.back().values.push_back(fit.ok ? fit.value : std::nan(""));
    }
  }
  for (const Signal& input : signals.inputs) {
    out.signals.inputs.push_back({input.name, input.unit, {}, input.sigma});
    for (const std::size_t row : out.rows) {
      if (row < input.values.size()) out.signals.inputs.back().values.push_back(input.values[row]);
    }
  }
  return out;
}

}  // namespace misfit
