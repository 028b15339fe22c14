#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "misfit/data/signals.h"
#include "misfit/model/model.h"

namespace misfit {

/// Noise of one measurement: white, and a resonance j'' + 2 ζ ω j' + ω² j = noise of stationary sigma `coloured`; what is read is the
/// nearest of `level` plus whole steps.
struct MeasurementNoise {
  double white = 0.0;               ///< sigma [unit]
  double coloured = 0.0;            ///< stationary sigma [unit]
  double coloured_frequency = 1.0;  ///< ω/2π [Hz]
  double coloured_damping = 0.3;    ///< ζ
  double step = 0.0, level = 0.0;   ///< [unit]; step 0: read as it is
};

/// A fitted model with all that is random about it.
struct StochasticModel {
  const Model* model = nullptr;         ///< random forces are own states of it
  std::vector<double> intensity;        ///< of each own state's noise, beside what its effect declares [unit/sqrt(s)]
  std::vector<double> start_sigma;      ///< of each own state at the start [unit]; 0: starts where x0 says
  std::vector<MeasurementNoise> noise;  ///< per output
};

/// One realisation of what would have been measured: `like` with other measurements, at the same times, driven by the same inputs, missing
/// where `like` misses. Starts at x0 (model states) plus start_sigma. nullopt if a state left the finite numbers.
[[nodiscard]] std::optional<Signals> noisy_run(const StochasticModel& model, const Signals& like, const std::vector<double>& x0,
                                               std::uint64_t seed);

}  // namespace misfit
