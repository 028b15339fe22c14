#pragma once

#include <array>
#include <vector>

#include "misfit/sim/trajectory.h"

namespace misfit {

/// Predicted outputs of a sample and their derivatives, each at the time at which it is taken. Where effects shift that time, of all
/// outputs or of one (the sensor ports after the outputs), the state is carried there by the step map itself, through the intervals between
/// and with their inputs; own effects of the sensors are those of the sample. One object per thread: scratch memory.
class SampledOutputs {
 public:
  explicit SampledOutputs(Stepper& stepper);

  /// At state x of sample i. `slots` is cleared first. False if the state cannot be carried to one of the times.
  [[nodiscard]] bool linearise(const Simulation& run, std::size_t i, const double* x, Slots& slots);
  [[nodiscard]] double y(int output) const { return y_[output]; }
  /// ∂y/∂x, then ∂y/∂(slot), of the last linearise().
  [[nodiscard]] const double* row(int output) const { return rows_.data() + output * kRowStride; }

 private:
  [[nodiscard]] bool carry(const Simulation& run, std::size_t i, double shift, const double* x);
  void write_row(int output, const Slots& slots);

  Evaluator& evaluator_;
  int n_, ny_, width_;
  std::array<double, kMaxSensorPorts> y_{}, moved_y_{};
  std::array<double, kMaxStates> moved_{}, speed_{};
  std::array<double, kMaxOutputs> by_inputs_{};  // of the outputs at the shifted time, as the inputs run there [output/s]
  std::vector<double> rows_;                     // of the outputs, then of the shifts; kRowStride each
  std::vector<double> D_, moved_rows_;           // of a step; of the outputs at the shifted time
  std::vector<double> shift_rows_;               // of the shift of each output: by the state and by every column
  std::vector<double> carried_, next_;           // ∂(state at the shifted time)/∂(state, every column)
  Slots step_slots_;
};

}  // namespace misfit
