#pragma once

#include <cmath>

#include "misfit/fit/filter_run.h"
#include "misfit/fit/kalman.h"

namespace misfit {

using ConstMap = Eigen::Map<const RowMatrix>;

/// Discretisations by step length: recordings have few distinct ones.
class NoiseSteps {
 public:
  explicit NoiseSteps(const FilterNoise& noise) : noise_(noise) {}
  const NoiseStep& at(double h) {
    if (!(std::abs(h - last_) <= 1e-9 * h)) {
      step_ = discretise(noise_, h);
      last_ = h;
    }
    return step_;
  }

 private:
  const FilterNoise& noise_;
  double last_ = -1.0;
  NoiseStep step_;
};

/// What is known before the first reading: states as uncertain as they are large, forces and jitter stationary.
template <int M, int NY>
void start_covariance(const FilterModel& model, const FilterData& data, const FilterNoise& noise, Kalman<M, NY>& kalman) {
  for (Eigen::Index i = 0; i < data.scale.size(); ++i) kalman.P(i, i) = data.scale[i] * data.scale[i];
  for (int f : model.force_states) kalman.P(f, f) = noise.force * noise.force;
  for (std::size_t o = 0; o < noise.channels.size(); ++o) {
    const auto at = static_cast<Eigen::Index>(2 * o);
    kalman.G(at, at) = kalman.G(at + 1, at + 1) = noise.channels[o].jitter * noise.channels[o].jitter;
  }
}

}  // namespace misfit
