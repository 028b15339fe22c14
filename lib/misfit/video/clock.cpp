#include "misfit/video/clock.h"

#include <algorithm>
#include <cmath>

namespace misfit {
namespace {

constexpr double rounding = 1.2e-3;        // [s] two times the 0.5 ms of a container that counts milliseconds, and a little
constexpr double largest_part = 0.3;       // … of an interval, where frames follow that fast
constexpr double allowed_outliers = 0.01;  // share of the timestamps

double median_interval(const std::vector<double>& times) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < times.size(); ++k) steps.push_back(times[k] - times[k - 1]);
  const auto middle = steps.begin() + steps.size() / 2;
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Do the times lie on the grid of this rate, no two on one place of it?
bool on_grid(const std::vector<double>& times, double rate) {
  std::size_t off = 0;
  double before = -1.0;
  for (const double t : times) {
    const double place = (t - times.front()) * rate, nearest = std::round(place);
    if (std::abs(place - nearest) > std::min(rounding * rate, largest_part) || nearest <= before) ++off;
    before = nearest;
  }
  return static_cast<double>(off) <= allowed_outliers * static_cast<double>(times.size());
}

/// Slope of the places over time, the places being counted by the median interval.
double fitted_rate(const std::vector<double>& times) {
  const double step = median_interval(times), n = static_cast<double>(times.size());
  std::vector<double> places{0.0};
  for (std::size_t k = 1; k < times.size(); ++k)
    places.push_back(places.back() + std::max(1.0, std::round((times[k] - times[k - 1]) / step)));
  double mean_t = 0.0, mean_p = 0.0, tt = 0.0, tp = 0.0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    mean_t += times[k] / n;
    mean_p += places[k] / n;
  }
  for (std::size_t k = 0; k < times.size(); ++k) {
    tt += (times[k] - mean_t) * (times[k] - mean_t);
    tp += (times[k] - mean_t) * (places[k] - mean_p);
  }
  return tp / tt;
}

}  // namespace

FrameClock clock_of(const std::vector<double>& timestamps, double declared) {
  if (timestamps.size() < 3 || on_grid(timestamps, declared)) return {true, declared};
  const double rate = fitted_rate(timestamps);
  if (std::isfinite(rate) && on_grid(timestamps, rate)) return {true, rate};
  return {false, 1.0 / median_interval(timestamps)};
}

long FrameNumbers::next(const std::optional<double>& time, double rate) {
  constexpr double near_grid = 0.3;    // of a frame: how far a time may be from it (containers round to 1 ms)
  constexpr double follow = 0.05;      // of what a time is off, per frame
  constexpr double largest_gap = 1e5;  // frames: beyond, times are not believed
  const double place = time ? *time * rate - drift_ : NAN, before = static_cast<double>(number_);
  ++number_;
  if (number_ == 0 || !(place < before + largest_gap)) return number_;
  const long nearest = std::lround(place);
  if (nearest > number_ && std::abs(place - static_cast<double>(nearest)) < near_grid) number_ = nearest;
  drift_ += follow * std::clamp(place - static_cast<double>(number_), -near_grid, near_grid);
  return number_;
}

}  // namespace misfit
