#include "misfit/model/recorded_inputs.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace misfit {
namespace {

/// A straight line at a time.
struct Line {
  double value = 0.0, slope = 0.0;
};

/// One input of a record as a function of time.
class InputInTime {
 public:
  InputInTime(const RecordedInputs& record, int input) : record_(record), input_(input), held_(record.hold[input] == Hold::zero_order) {}

  /// Last sample not after `time`, the first one before the record.
  [[nodiscard]] std::size_t sample_at(double time) const { return std::max<std::size_t>(samples_until(time), 1) - 1; }

  [[nodiscard]] double next_sample_after(double time) const {
    const std::size_t next = samples_until(time);
    return next == record_.t.size() ? std::numeric_limits<double>::infinity() : record_.t[next];
  }

  /// Value and slope between samples k and k + 1, as a straight line or held.
  [[nodiscard]] Line between(std::size_t k, double time, bool held) const {
    const double value = record_.value(k, input_);
    if (held || k + 1 >= record_.t.size() || time <= record_.t[k]) return {value, 0.0};
    const double slope = (record_.value(k + 1, input_) - value) / (record_.t[k + 1] - record_.t[k]);
    return {value + slope * (time - record_.t[k]), slope};
  }
  [[nodiscard]] double at(double time) const { return between(sample_at(time), time, held_).value; }
  [[nodiscard]] Line linearly(double time) const { return between(sample_at(time), time, false); }

  /// ∫ u dt and ∫ (t − middle) u dt from `begin` to `end`, where u is a straight line between its samples.
  struct Moments {
    double zeroth = 0.0, first = 0.0;
  };
  [[nodiscard]] Moments moments(double begin, double end) const {
    const double middle = 0.5 * (begin + end);
    Moments out;
    for (double from = begin; from < end;) {
      // The straight line up to the next sample, about its own middle.
      const double to = std::min(end, next_sample_after(from)), m = 0.5 * (from + to), length = to - from;
      const Line line = between(sample_at(m), m, held_);
      out.zeroth += length * line.value;
      out.first += length * ((m - middle) * line.value + length * length * line.slope / 12.0);
      from = to;
    }
    return out;
  }

 private:
  /// How many samples are not after `time`. In an evenly sampled record they are known by their number.
  [[nodiscard]] std::size_t samples_until(double time) const {
    const auto& t = record_.t;
    if (t.empty() || !(time >= t.front())) return 0;
    if (time >= t.back()) return t.size();
    const double even = (time - t.front()) / (t.back() - t.front()) * static_cast<double>(t.size() - 1);
    const auto guess = static_cast<std::size_t>(even);
    for (std::size_t k = std::max<std::size_t>(guess, 1) - 1; k < guess + 2 && k + 1 < t.size(); ++k) {
      if (t[k] <= time && time < t[k + 1]) return k + 1;
    }
    return static_cast<std::size_t>(std::upper_bound(t.begin(), t.end(), time) - t.begin());
  }

  const RecordedInputs& record_;
  int input_;
  bool held_;
};

}  // namespace

LateInput late_input(const InputsAt& inputs, int input, double t, double delay) {
  if (inputs.record == nullptr) return {inputs.values[input], 0.0};
  const InputInTime u(*inputs.record, input);
  const double begin = std::min(inputs.from, inputs.to), length = std::abs(inputs.to - inputs.from);
  if (!(length > 0.0)) {
    const Line then = u.linearly(t - delay);
    return {then.value, -then.slope};
  }
  // u ≈ a + b (t − middle): a = M0/h, b = 12 M1/h³ with the moments of the earlier interval. By the delay: M0' = −(u(end) − u(begin)),
  // M1' = −h/2 (u(end) + u(begin)) + M0.
  const double then = begin - delay;
  const auto moments = u.moments(then, then + length);
  const double first = u.at(then), last = u.at(then + length), cube = length * length * length;
  const double mean_by_delay = (first - last) / length;
  const double slope = 12.0 * moments.first / cube;
  const double slope_by_delay = 12.0 * (moments.zeroth - 0.5 * length * (last + first)) / cube;
  const double from_middle = t - (begin + 0.5 * length);
  return {moments.zeroth / length + slope * from_middle, mean_by_delay + slope_by_delay * from_middle};
}

}  // namespace misfit
