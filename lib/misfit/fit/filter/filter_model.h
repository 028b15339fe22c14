#pragma once

#include <vector>

#include "misfit/model/model.h"

namespace misfit {

/// A model with the random force as own states: F' = −F/force_time + white noise on every force port (SystemSpec::force_ports; where a
/// system names none, every dynamic port with a conjugate rate, else every dynamic port).
struct FilterModel {
  Model model;                    ///< the given one, then one effect per force port and the fixed parameter `force_time` at the end
  std::vector<int> force_states;  ///< state index of each force
  std::vector<int> force_ports;   ///< dynamic port of each
  std::vector<int> force_group;   ///< of each: ports of one dimension have one strength (FilterNoise::force_of), the first have group 0
  std::vector<int> kind;          ///< of each state: 0 force, 1 rate, 2 level (NoiseStep)
  int time_parameter = 0;
  /// Of each channel, the whole steps that its measurements are read in, 0: none; empty: no channel is. What reads them is off in `model`:
  /// it belongs to the update (reading.h), not to the prediction.
  std::vector<double> steps = {};

  [[nodiscard]] int force_groups() const;  ///< at least 1
  [[nodiscard]] double force_time() const { return model.parameters[time_parameter].value; }
  void set_force_time(double seconds) { model.parameters[time_parameter].value = seconds; }
};
/// RunError if there are more states than kMaxStates.
[[nodiscard]] FilterModel with_random_force(const Model& model);

/// The same model with every parameter fixed: no derivative columns, for runs that need values only.
[[nodiscard]] Model all_fixed(Model model);

}  // namespace misfit
