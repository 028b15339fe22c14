#include "misfit/model/recorded_inputs.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace misfit {
namespace {

/// From one instant to the next, each with the input's value and rate there, at a share of the way of `length` [s]; a band limited one by
/// both rates (Hermite's cubic).
RunningInput run_between(Hold hold, const RunningInput& from, const RunningInput& to, double share, double length) {
  if (hold == Hold::zero_order) return {from.value, 0.0};
  const double change = to.value - from.value, chord = change / length;
  const RunningInput line{from.value + share * change, chord};
  if (hold == Hold::first_order) return line;
  const double rest = 1.0 - share, bend_from = from.rate - chord, bend_to = to.rate - chord;
  return {line.value + share * rest * length * (rest * bend_from - share * bend_to),
          chord + rest * (1.0 - 3.0 * share) * bend_from - share * (2.0 - 3.0 * share) * bend_to};
}

/// Slopes at the samples of the cubic spline through them: slopes that make the curvature continuous are the solution of a tridiagonal
/// system, by elimination from the first to the last and back.
Eigen::VectorXd slopes_of_spline(const std::vector<double>& t, const Eigen::VectorXd& u) {
  const Eigen::Index n = u.size();
  Eigen::VectorXd slopes = Eigen::VectorXd::Zero(n), above = slopes;
  if (n < 2) return slopes;
  double before = 0.0, chord_before = 0.0;  // of the interval before sample k: 1/length, and the slope of its straight line
  for (Eigen::Index k = 0; k < n; ++k) {
    const double after = k + 1 < n ? 1.0 / (t[k + 1] - t[k]) : 0.0;
    const double chord = k + 1 < n ? after * (u[k + 1] - u[k]) : 0.0;
    double diagonal = 2.0 * (before + after), right = 3.0 * (before * chord_before + after * chord);
    if (k > 0) {
      diagonal -= before * above[k - 1];
      right -= before * slopes[k - 1];
    }
    above[k] = after / diagonal;
    slopes[k] = right / diagonal;
    before = after;
    chord_before = chord;
  }
  for (Eigen::Index k = n - 2; k >= 0; --k) slopes[k] -= above[k] * slopes[k + 1];
  return slopes;
}

/// One input of a record as a function of time.
class InputInTime {
 public:
  /// `before`: added to the first value, before the record.
  InputInTime(const RecordedInputs& record, int input, double before)
      : record_(record), input_(input), before_(before), hold_(record.hold[input]) {
    if (hold_ == Hold::band_limited && record.slopes.empty()) hold_ = Hold::first_order;
  }

  /// Last sample not after `time`, the first one before the record.
  [[nodiscard]] std::size_t sample_at(double time) const { return std::max<std::size_t>(samples_until(time), 1) - 1; }

  [[nodiscard]] double next_sample_after(double time) const {
    const std::size_t next = samples_until(time);
    return next == record_.t.size() ? std::numeric_limits<double>::infinity() : record_.t[next];
  }

  /// Between samples k and k + 1.
  [[nodiscard]] RunningInput between(std::size_t k, double time, Hold hold) const {
    if (time < record_.t.front()) return {record_.value(0, input_) + before_, 0.0};
    if (k + 1 >= record_.t.size() || time <= record_.t[k]) return {record_.value(k, input_), 0.0};
    const double length = record_.t[k + 1] - record_.t[k];
    return run_between(hold, sample(k), sample(k + 1), (time - record_.t[k]) / length, length);
  }
  [[nodiscard]] double at(double time) const { return between(sample_at(time), time, hold_).value; }
  /// Not held: linearly, or as a band limited input runs.
  [[nodiscard]] RunningInput running(double time) const {
    return between(sample_at(time), time, hold_ == Hold::zero_order ? Hold::first_order : hold_);
  }

  /// ∫ u dt and ∫ (t − middle) u dt from `begin` to `end`.
  struct Moments {
    double zeroth = 0.0, first = 0.0;
  };
  [[nodiscard]] Moments moments(double begin, double end) const {
    const double middle = 0.5 * (begin + end);
    Moments out;
    for (double from = begin; from < end;) {
      const double to = std::min(end, next_sample_after(from));
      const Moments part = hold_ == Hold::band_limited ? of_cubic(from, to, middle) : of_line(from, to, middle);
      out.zeroth += part.zeroth;
      out.first += part.first;
      from = to;
    }
    return out;
  }

 private:
  /// Within an interval between two samples: the straight line about its own middle.
  [[nodiscard]] Moments of_line(double from, double to, double middle) const {
    const double m = 0.5 * (from + to), length = to - from;
    const RunningInput line = between(sample_at(m), m, hold_);
    return {length * line.value, length * ((m - middle) * line.value + length * length * line.rate / 12.0)};
  }
  /// By Gauss's rule of three points (Abramowitz and Stegun, Handbook (1964), table 25.4), exact for a cubic.
  [[nodiscard]] Moments of_cubic(double from, double to, double middle) const {
    constexpr std::array<std::pair<double, double>, 3> points = {
        {{-0.7745966692414834, 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {0.7745966692414834, 5.0 / 9.0}}};
    const double m = 0.5 * (from + to), half = 0.5 * (to - from);
    const std::size_t k = sample_at(m);
    Moments out;
    for (const auto& [at, weight] : points) {
      const double time = m + half * at, part = half * weight * between(k, time, hold_).value;
      out.zeroth += part;
      out.first += (time - middle) * part;
    }
    return out;
  }

  [[nodiscard]] RunningInput sample(std::size_t k) const {
    const std::size_t at = k * record_.stride() + input_;
    return {record_.values[at], hold_ == Hold::band_limited ? record_.slopes[at] : 0.0};
  }

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
  double before_;
  Hold hold_;
};

}  // namespace

void set_slopes(RecordedInputs& record) {
  const bool any = std::find(record.hold.begin(), record.hold.end(), Hold::band_limited) != record.hold.end();
  record.slopes.assign(any ? record.values.size() : 0, 0.0);
  for (std::size_t k = 0; k < record.hold.size(); ++k) {
    if (record.hold[k] != Hold::band_limited) continue;
    Eigen::VectorXd u(record.t.size());
    for (Eigen::Index i = 0; i < u.size(); ++i) u[i] = record.value(i, static_cast<int>(k));
    const Eigen::VectorXd slopes = slopes_of_spline(record.t, u);
    for (Eigen::Index i = 0; i < u.size(); ++i) record.slopes[i * record.stride() + k] = slopes[i];
  }
}

RunningInput input_within(Hold hold, const InputsAt& begin, const InputsAt& end, int i, double share, double length) {
  const bool known = begin.slopes != nullptr && end.slopes != nullptr;
  const auto at = [&](const InputsAt& instant) { return RunningInput{instant.values[i], known ? instant.slopes[i] : 0.0}; };
  return run_between(hold == Hold::band_limited && !known ? Hold::first_order : hold, at(begin), at(end), share, length);
}

LateInput late_input(const InputsAt& inputs, int input, double t, double delay) {
  if (inputs.record == nullptr) return {inputs.values[input], 0.0};
  const InputInTime u(*inputs.record, input, inputs.before == nullptr ? 0.0 : inputs.before[input]);
  const double begin = std::min(inputs.from, inputs.to), length = std::abs(inputs.to - inputs.from);
  if (!(length > 0.0)) {
    const RunningInput then = u.running(t - delay);
    return {then.value, -then.rate};
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
