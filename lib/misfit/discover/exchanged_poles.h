#pragma once

#include <optional>
#include <string>
#include <vector>

#include "misfit/fit/filter/filter_estimate.h"

namespace misfit {

// A lag in series with a first-order system is the same transfer function in either order: 1/((1 + s tau)(1 + s T)). Which of the two time
// constants is the lag's is told, if at all, by where the random force and the noise enter, and by the start of the motion; a search ends
// at the order in whose basin it begins.

/// The parameter that is the time constant [s] of the model's last effect, one that as a whole is in series with the system (of an input,
/// of a sensor), remembers linearly and has just one such; -1: it has none, or it is fixed.
[[nodiscard]] int time_constant_of(const Model& model);

/// Of the system's equations, linearised in the middle of the first recording: -1/pole of its real, stable poles that the recording can
/// show, from half of its usual interval to half of its length [s].
[[nodiscard]] std::vector<double> time_constants_of_system(const FilterEstimate& estimate);

/// The parameter of the system that moves the time constant `constant` most, and the value at which it is `wanted` instead; nullopt where
/// none moves it so far.
struct MovedPole {
  int parameter = -1;
  double value = 0.0;
};
[[nodiscard]] std::optional<MovedPole> moved_pole(const FilterEstimate& estimate, double constant, double wanted);

/// "a second solution is about as good: input_tau = 0.06 s with damping = 2.5 1/s (its drop is lower by 7.8); …": the parameters of `other`
/// that differ most from those of the estimate.
[[nodiscard]] std::string exchange_in_words(const FilterEstimate& estimate, const FilterEstimate& other, int time);

}  // namespace misfit
