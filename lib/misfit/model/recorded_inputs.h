#pragma once

#include <cstddef>
#include <vector>

#include "misfit/model/system.h"

namespace misfit {

/// Inputs of an experiment as they were recorded, for effects that read their past: samples × max(inputs, 1).
struct RecordedInputs {
  std::vector<double> t;  ///< [s], increasing
  std::vector<Hold> hold;
  std::vector<double> values;  ///< sample-major, of the inputs that `hold` lists

  [[nodiscard]] std::size_t stride() const { return hold.empty() ? 1 : hold.size(); }
  [[nodiscard]] double value(std::size_t sample, int input) const { return values[sample * stride() + input]; }
};

/// Inputs at an instant of an experiment, and where their past can be read. `from`, `to`: ends of the sample interval that is run, [s]; the
/// same: at a sample, or wherever nothing is run.
struct InputsAt {
  const double* values = nullptr;
  const RecordedInputs* record = nullptr;  ///< nullptr: the inputs have always been as they are
  double from = 0.0, to = 0.0;

  InputsAt() = default;
  InputsAt(const double* now) : values(now) {}  // NOLINT(google-explicit-constructor, hicpp-explicit-conversions): no past
  InputsAt(const double* now, const RecordedInputs* recorded, double begin = 0.0, double end = 0.0)
      : values(now), record(recorded), from(begin), to(end) {}
};

/// An input as it was `delay` before an instant [its unit], and the derivative by the delay.
struct LateInput {
  double value = 0.0, by_delay = 0.0;
};

/// u(t − delay); before the record its first value, after it the last. Where an interval is run, the straight line over it that has the
/// mean and the first moment of what the input was, by its Hold, over the interval that is `delay` earlier: so jumps that fall between two
/// samples act at their time to third order in the interval, a delay of whole intervals of even samples is exact, and the derivative is
/// that of the line. At a sample: between samples linearly.
[[nodiscard]] LateInput late_input(const InputsAt& inputs, int input, double t, double delay);

}  // namespace misfit
