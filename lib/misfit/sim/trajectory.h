#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "misfit/sim/step.h"

namespace misfit {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The inputs of an experiment, sample-major, for the stepper, and how it goes from sample to sample.
struct InputTable {
  RecordedInputs recorded;
  IntegrationPlan plan = {};  ///< none: parts as the fastest rate at the start of a trajectory asks (planner.h makes one)
  [[nodiscard]] InputsAt at(std::size_t sample) const {
    const std::size_t row = sample * recorded.stride();
    InputsAt out{recorded.values.data() + row, &recorded};
    if (!recorded.slopes.empty()) out.slopes = recorded.slopes.data() + row;
    return out;
  }
};
[[nodiscard]] InputTable input_table(const Signals& signals, const Model& model);
/// All inputs at a share (0 … 1) of the way of `length` [s] from a sample to the next, as their holds say: one that is held has its value
/// still at the end.
[[nodiscard]] std::vector<double> inputs_within(const InputTable& inputs, std::size_t sample, double share, double length);

/// What is run: a model on the inputs of a recording. The parameters are those the stepper's evaluator holds.
struct Simulation {
  Stepper& stepper;
  const Signals& signals;
  const InputTable& inputs;
};

/// Samples first … last − 1, from the state x0 at the first.
struct Stretch {
  std::size_t first = 0, last = 0;
  const double* x0 = nullptr;
  bool sensitivities = false;  ///< derivatives too
  std::size_t batch = 0;       ///< run_in_batches: samples handed over at once; 0: all
};

/// From sample i to the next, with its parts.
[[nodiscard]] Interval interval_after(const Simulation& run, std::size_t i);
/// Stepper::prepare() at state x of sample i.
void prepare_at(const Simulation& run, std::size_t i, const double* x);

/// Predicted outputs y (Evaluator::sensor_ports() places) at sample i, each at the time at which it is taken: see SampledOutputs. False if
/// the state cannot be carried there.
[[nodiscard]] bool predict_at(const Simulation& simulation, std::size_t i, const double* x, double* y);

/// What a run over samples first … last − 1 predicts. Sample `last` (if it exists) is where the next segment starts.
struct Segment {
  std::size_t first = 0, last = 0;
  RowMatrix y;          ///< samples × outputs
  RowMatrix y_rows;     ///< ∂y/∂(θ, x0): (samples · outputs) × (columns + states), row = sample · outputs + output
  Eigen::VectorXd end;  ///< state at sample `last`, or at the last sample if there is none after it
  RowMatrix end_rows;   ///< ∂end/∂(θ, x0): states × (columns + states)
  bool finite = false;  ///< false: a state left the finite numbers at sample `failed_at`; nothing else may be used
  std::size_t failed_at = 0;
};

/// Runs the model over a stretch. Matrices are resized only when their size changes: reuse `out` to avoid allocation.
void run_segment(const Simulation& simulation, const Stretch& stretch, Segment& out);

/// The same in batches, for those who need every row once and no longer: `out` (first, last, y, y_rows) is handed to `take`, which may
/// change it, and then reused; `end` and `finite` are those of the whole run.
void run_in_batches(const Simulation& simulation, const Stretch& stretch, Segment& out, const std::function<void(Segment&)>& take);

/// States at every sample (samples × states), without derivatives; stops early (fewer rows) where a state is not finite.
[[nodiscard]] RowMatrix run_states(const Simulation& simulation, const Stretch& stretch);

}  // namespace misfit
