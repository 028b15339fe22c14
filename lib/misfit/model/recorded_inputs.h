#pragma once

#include <cstddef>
#include <vector>

#include "misfit/model/system.h"

namespace misfit {

/// Inputs of an experiment as they were recorded, for effects that read their past: samples × max(inputs, 1).
struct RecordedInputs {
  std::vector<double> t;  ///< [s], increasing
  std::vector<Hold> hold;
  std::vector<double> values;       ///< sample-major, of the inputs that `hold` lists
  std::vector<double> slopes = {};  ///< du/dt at the samples, in the places of `values`; empty: no input is Hold::band_limited

  [[nodiscard]] std::size_t stride() const { return hold.empty() ? 1 : hold.size(); }
  [[nodiscard]] double value(std::size_t sample, int input) const { return values[sample * stride() + input]; }
};

/// Fills `slopes` where an input is band limited: those of its cubic spline with continuous curvature, which is zero at both ends (de Boor,
/// A Practical Guide to Splines (2001), ch. IV).
void set_slopes(RecordedInputs& record);

/// Inputs at an instant of an experiment, and where their past can be read. `from`, `to`: ends of the sample interval that is run, [s]; the
/// same: at a sample, or wherever nothing is run.
struct InputsAt {
  const double* values = nullptr;
  const RecordedInputs* record = nullptr;  ///< nullptr: the inputs have always been as they are
  double from = 0.0, to = 0.0;
  const double* slopes = nullptr;  ///< du/dt; nullptr: not known, and no input is taken for band limited
  /// Of each input, how far from its first value it was before the record; nullptr: there it was as at the first sample.
  const double* before = nullptr;

  InputsAt() = default;
  InputsAt(const double* now) : values(now) {}  // NOLINT(google-explicit-constructor, hicpp-explicit-conversions): no past
  InputsAt(const double* now, const RecordedInputs* recorded, double begin = 0.0, double end = 0.0)
      : values(now), record(recorded), from(begin), to(end) {}
};

/// An input within an interval, and how fast it runs there.
struct RunningInput {
  double value = 0.0, rate = 0.0;
};
/// Input `i` at a share (0 … 1) of the interval of `length` [s] between two instants: as its Hold says; of a band limited one the cubic
/// with the values and slopes of both ends (Hermite), or a straight line where the slopes are not known.
[[nodiscard]] RunningInput input_within(Hold hold, const InputsAt& begin, const InputsAt& end, int i, double share, double length);

/// An input as it was `delay` before an instant [its unit], and the derivative by the delay.
struct LateInput {
  double value = 0.0, by_delay = 0.0;
};

/// u(t − delay); before the record its first value (and what InputsAt::before adds), after it the last. Where an interval is run, the
/// straight line over it that has the mean and the first moment of what the input was, by its Hold, over the interval that is `delay`
/// earlier: so jumps that fall between two samples act at their time to third order in the interval, a delay of whole intervals of even
/// samples is exact, and the derivative is that of the line. At a sample: between samples linearly, or as a band limited input runs.
[[nodiscard]] LateInput late_input(const InputsAt& inputs, int input, double t, double delay);

}  // namespace misfit
