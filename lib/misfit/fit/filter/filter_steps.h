#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "misfit/fit/filter/filter_run.h"
#include "misfit/fit/filter/kalman.h"

namespace misfit {

/// Discretisations by step length: recordings have few distinct ones, often two or three in turn (times with few digits).
class NoiseSteps {
 public:
  explicit NoiseSteps(const FilterNoise& noise) : noise_(noise) { lengths_.fill(-1.0); }
  const NoiseStep& at(double h) {
    for (std::size_t i = 0; i < kept; ++i) {
      if (std::abs(h - lengths_[i]) <= 1e-9 * h) return steps_[i];
    }
    const std::size_t oldest = next_++ % kept;
    lengths_[oldest] = h;
    return steps_[oldest] = discretise(noise_, h);
  }

 private:
  static constexpr std::size_t kept = 4;
  const FilterNoise& noise_;
  std::array<double, kept> lengths_;
  std::array<NoiseStep, kept> steps_;
  std::size_t next_ = 0;
};

/// What is known before the first measurement: states as uncertain as FilterData says, forces and coloured noise stationary.
template <int M, int NY>
void start_covariance(const FilterModel& model, const FilterData& data, const FilterNoise& noise, Kalman<M, NY>& kalman) {
  kalman.P = data.covariance;
  for (std::size_t i = 0; i < model.force_states.size(); ++i) {
    const int f = model.force_states[i];
    const double force = noise.force_of(model.force_group[i]);
    kalman.P(f, f) = force * force;
  }
  for (std::size_t o = 0; o < noise.channels.size(); ++o) {
    const Eigen::Index at = 2 * o;
    kalman.G(at, at) = kalman.G(at + 1, at + 1) = noise.channels[o].coloured * noise.channels[o].coloured;
  }
}

}  // namespace misfit
