#pragma once

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

/// A channel whose sensor has a clock of its own (own_clocks.h): rows between its samples have no value of it. At a sample the
/// local quadratic over the channel's own neighbours, between two the mean of theirs, weighed by the time to them: interpolation through
/// noisy values would have far noisier derivatives. Nothing ahead of the first sample, behind the last and where more than five usual steps
/// lie between two.
class OwnSamples {
 public:
  OwnSamples(const std::vector<double>& t, const std::vector<double>& y);

  [[nodiscard]] LocalFit at(double time) const;

 private:
  std::vector<double> t_, y_;
  std::vector<LocalFit> fits_;
  double h_ = 0.0;
};

/// A recording whose rows are the samples of the channel that has most, with the values of all channels there.
struct DensestRows {
  Signals signals;
  std::vector<std::size_t> rows;  ///< of the whole recording
};
[[nodiscard]] DensestRows at_densest(const Signals& signals);

}  // namespace misfit
