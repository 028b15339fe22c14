#include "misfit/inference/slow_channel.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

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

}  // namespace

LocalFit local_quadratic(const Series& series, std::size_t i) {
  constexpr std::size_t usual = 2, farthest = 4;
  for (std::size_t reach = usual; reach <= farthest; ++reach) {
    const LocalFit fit = quadratic_within(series, i, reach);
    if (fit.ok) return fit;
  }
  return {};
}

std::optional<SlowChannel> SlowChannel::of(const std::vector<double>& t, const std::vector<double>& y) {
  constexpr double slower = 1.2;
  constexpr std::size_t least = 5;
  SlowChannel out;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!std::isfinite(y[i])) continue;
    out.t_.push_back(t[i]);
    out.y_.push_back(y[i]);
  }
  if (out.t_.size() < least || out.t_.size() == t.size()) return std::nullopt;
  out.h_ = usual_step(out.t_);
  if (!(out.h_ > slower * usual_step(t))) return std::nullopt;
  for (std::size_t k = 0; k < out.t_.size(); ++k) out.fits_.push_back(local_quadratic({out.t_, out.y_, out.h_}, k));
  return out;
}

LocalFit SlowChannel::at(double time) const {
  constexpr double longest = 5.0;  // usual steps
  const auto after = std::upper_bound(t_.begin(), t_.end(), time);
  if (after == t_.begin()) return {};
  const auto k = static_cast<std::size_t>(after - t_.begin()) - 1;
  if (t_[k] == time) return fits_[k];
  if (k + 1 == t_.size() || !fits_[k].ok || !fits_[k + 1].ok || t_[k + 1] - t_[k] > longest * h_) return {};
  const double h = t_[k + 1] - t_[k], s = (time - t_[k]) / h;
  const double a = fits_[k].value, b = h * fits_[k].slope, difference = fits_[k + 1].value - a, end = h * fits_[k + 1].slope;
  const double c = 3.0 * difference - 2.0 * b - end, d = b + end - 2.0 * difference;  // a + b s + c s² + d s³
  return {a + s * (b + s * (c + s * d)), (b + s * (2.0 * c + 3.0 * d * s)) / h, (2.0 * c + 6.0 * d * s) / (h * h), true};
}

Signals with_slow_channels_filled(const Signals& signals) {
  Signals out = signals;
  for (Signal& channel : out.measured) {
    const std::optional<SlowChannel> slow = SlowChannel::of(signals.t, channel.values);
    for (std::size_t i = 0; slow && i < signals.samples(); ++i) {
      const LocalFit fit = slow->at(signals.t[i]);
      channel.values[i] = fit.ok ? fit.value : std::nan("");
    }
  }
  return out;
}

}  // namespace misfit
