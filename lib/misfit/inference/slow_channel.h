#pragma once

#include <optional>
#include <vector>

#include "misfit/data/signals.h"

namespace misfit {

/// Value, slope and second derivative by the time.
struct LocalFit {
  double value = 0.0, slope = 0.0, curvature = 0.0;  ///< of f, f', f''
  bool ok = false;
};

/// Samples of one series.
struct Series {
  const std::vector<double>&t, &y;
  double h;  ///< usual step
};

/// Quadratic least squares about sample i over its neighbours: see reconstruct_states().
[[nodiscard]] LocalFit local_quadratic(const Series& series, std::size_t i);

/// A channel that has a clock of its own, slower than the rows of its recording: most rows have no value of it. Cubic Hermite
/// interpolation between its own samples, whose values and slopes are those of local quadratics over the channel's own neighbours; nothing
/// ahead of the first, behind the last and where more than five of its usual steps lie between two.
class SlowChannel {
 public:
  /// nullopt: the usual step of its samples is no longer than 1.2 usual steps of the rows.
  [[nodiscard]] static std::optional<SlowChannel> of(const std::vector<double>& t, const std::vector<double>& y);

  [[nodiscard]] LocalFit at(double time) const;

 private:
  std::vector<double> t_, y_;
  std::vector<LocalFit> fits_;
  double h_ = 0.0;
};

/// The recording with the values of slow channels at every row.
[[nodiscard]] Signals with_slow_channels_filled(const Signals& signals);

}  // namespace misfit
