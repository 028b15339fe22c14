#include "misfit/sim/sampled_outputs.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace misfit {
namespace {

/// Inputs at a time within interval k, between samples k and k + 1, as each is held there.
void inputs_within(const Simulation& run, std::size_t k, double t, double* u) {
  const auto& [stepper, signals, inputs] = run;
  const double length = signals.t[k + 1] - signals.t[k], share = (t - signals.t[k]) / length;
  for (int j = 0; j < std::ssize(inputs.recorded.hold); ++j)
    u[j] = input_within(inputs.recorded.hold[j], inputs.at(k), inputs.at(k + 1), j, share, length).value;
}

/// The inputs at the time that was reached, and how fast they run in the interval on the way there: not at all where they are held, or
/// beyond the record.
struct Reached {
  std::array<double, kMaxInputs> u{}, rate{};
  double t = 0.0, length = 0.0;  ///< of that interval
  [[nodiscard]] bool inputs_run() const {
    return std::any_of(rate.begin(), rate.end(), [](double r) { return r != 0.0; });
  }
};

/// Into `reached`, those of interval k at time `t`.
void note_rates(const Simulation& run, std::size_t k, double t, Reached& reached) {
  const auto& [stepper, signals, inputs] = run;
  reached.length = signals.t[k + 1] - signals.t[k];
  const double share = (t - signals.t[k]) / reached.length;
  for (int j = 0; j < std::ssize(inputs.recorded.hold); ++j)
    reached.rate[j] = input_within(inputs.recorded.hold[j], inputs.at(k), inputs.at(k + 1), j, share, reached.length).rate;
}

/// step(interval) for each piece of the way from sample i to the time `shift` after or before it. Before the first and after the last
/// sample inputs stay as they are there. False as soon as a step is.
template <class Step>
bool along(const Simulation& run, std::size_t i, double shift, Reached& reached, const Step& step) {
  const auto& [stepper, signals, inputs] = run;
  std::array<double, kMaxInputs> begin{};
  const std::size_t count = inputs.recorded.hold.size();
  std::copy_n(inputs.at(i).values, count, reached.u.begin());
  reached.t = signals.t[i];
  if (i + 1 < signals.samples()) note_rates(run, i, reached.t, reached);
  const double end = reached.t + shift;
  for (std::size_t k = i; reached.t != end;) {
    const bool forward = end > reached.t;
    if (forward ? k + 1 >= signals.samples() : k == 0) {
      const std::size_t beside = forward ? k - 1 : k;  // the interval whose length its pieces have
      const double length = signals.samples() > 1 ? signals.t[beside + 1] - signals.t[beside] : std::abs(shift);
      const double to = std::abs(end - reached.t) <= length ? end : reached.t + std::copysign(length, shift);
      if (!step({reached.t, to, inputs.at(k), inputs.at(k)})) return false;
      reached.t = to;
      reached.rate.fill(0.0);
      continue;
    }
    const std::size_t of = forward ? k : k - 1;
    const double to = forward ? std::min(end, signals.t[of + 1]) : std::max(end, signals.t[of]);
    inputs_within(run, of, reached.t, begin.data());
    inputs_within(run, of, to, reached.u.data());
    note_rates(run, of, to, reached);
    const InputsAt from{begin.data(), &inputs.recorded}, at{reached.u.data(), &inputs.recorded};
    if (!step({reached.t, to, from, at, inputs.plan.of(of), inputs.plan.rate_at(of)})) return false;
    reached.t = to;
    k = forward ? of + 1 : of;
  }
  return true;
}

}  // namespace

bool predict_at(const Simulation& simulation, std::size_t i, const double* x, double* y) {
  const auto& [stepper, signals, inputs] = simulation;
  Evaluator& evaluator = stepper.evaluator();
  evaluator.predict(x, inputs.at(i), signals.t[i], y);
  if (!evaluator.shifts_time()) return true;
  std::array<double, kMaxSensorPorts> there{};
  std::array<double, kMaxStates> moved{};
  double reached_shift = 0.0;
  for (int o = 0; o < evaluator.outputs(); ++o) {
    const double shift = evaluator.time_shift(y, o);
    if (shift == 0.0) continue;
    if (shift != std::exchange(reached_shift, shift)) {
      Reached reached;
      std::copy_n(x, stepper.states(), moved.begin());
      if (!along(simulation, i, shift, reached, [&](const Interval& piece) { return stepper.step(moved.data(), piece); })) return false;
      evaluator.predict(moved.data(), {reached.u.data(), &inputs.recorded}, signals.t[i], there.data());
    }
    y[o] = there[o];
  }
  return true;
}

SampledOutputs::SampledOutputs(Stepper& stepper)
    : evaluator_(stepper.evaluator()), n_(stepper.states()), ny_(evaluator_.outputs()), width_(n_ + evaluator_.columns()) {
  rows_.assign(evaluator_.sensor_ports() * kRowStride, 0.0);
  if (!evaluator_.shifts_time()) return;
  const std::size_t states = n_, width = width_;
  D_.assign(states * kRowStride, 0.0);
  moved_rows_ = rows_;
  shift_rows_.assign(ny_ * width, 0.0);
  carried_.assign(states * width, 0.0);
  next_ = carried_;
}

/// The state and its derivatives at the shifted time, and how fast the state moves there, and the outputs with the inputs.
bool SampledOutputs::carry(const Simulation& run, std::size_t i, double shift, const double* x) {
  std::copy_n(x, n_, moved_.begin());
  std::fill(carried_.begin(), carried_.end(), 0.0);
  for (int j = 0; j < n_; ++j) carried_[j * width_ + j] = 1.0;
  Reached reached;
  const bool there = along(run, i, shift, reached, [&](const Interval& piece) {
    if (!run.stepper.step_linear(moved_.data(), piece, step_slots_, D_.data())) return false;
    for (int r = 0; r < n_; ++r) {
      const double* row = D_.data() + r * kRowStride;
      double* next = next_.data() + static_cast<std::ptrdiff_t>(r) * width_;
      std::fill_n(next, width_, 0.0);
      for (int j = 0; j < n_; ++j) {
        for (int c = 0; c < width_; ++c) next[c] += row[j] * carried_[j * width_ + c];
      }
      for (int s = 0; s < step_slots_.count(); ++s) next[n_ + step_slots_.column(s)] += row[n_ + s];
    }
    carried_.swap(next_);
    return true;
  });
  if (!there) return false;
  const InputsAt u{reached.u.data(), &run.inputs.recorded};
  evaluator_.rates(moved_.data(), u, reached.t, speed_.data());
  step_slots_.clear();
  evaluator_.linearise_outputs({moved_.data(), u, run.signals.t[i]}, step_slots_, moved_y_.data(), moved_rows_.data());
  by_inputs_.fill(0.0);
  if (!reached.inputs_run()) return true;
  const double beside = 1e-3 * reached.length;
  const auto predict_after = [&](double time, std::array<double, kMaxSensorPorts>& y) {
    std::array<double, kMaxInputs> then{};
    for (std::size_t j = 0; j < then.size(); ++j) then[j] = reached.u[j] + time * reached.rate[j];
    evaluator_.predict(moved_.data(), {then.data(), &run.inputs.recorded}, run.signals.t[i], y.data());
  };
  std::array<double, kMaxSensorPorts> before{}, after{};
  predict_after(-beside, before);
  predict_after(beside, after);
  for (int o = 0; o < ny_; ++o) by_inputs_[o] = (after[o] - before[o]) / (2.0 * beside);
  return true;
}

/// Of an output at the carried state: `slots` are those of its row, each the number of its column.
void SampledOutputs::write_row(int output, const Slots& slots) {
  const double* at_moved = moved_rows_.data() + output * kRowStride;
  double* row = rows_.data() + output * kRowStride;
  double motion = by_inputs_[output];
  for (int j = 0; j < n_; ++j) motion += at_moved[j] * speed_[j];
  const double* by_shift = shift_rows_.data() + static_cast<std::ptrdiff_t>(output) * width_;
  for (int c = 0; c < n_ + slots.count(); ++c) row[c] = motion * by_shift[c];
  for (int j = 0; j < n_; ++j) {
    for (int c = 0; c < n_ + slots.count(); ++c) row[c] += at_moved[j] * carried_[j * width_ + c];
  }
  for (int s = 0; s < step_slots_.count(); ++s) row[n_ + step_slots_.column(s)] += at_moved[n_ + s];
}

bool SampledOutputs::linearise(const Simulation& run, std::size_t i, const double* x, Slots& slots) {
  slots.clear();
  evaluator_.linearise_outputs({x, run.inputs.at(i), run.signals.t[i]}, slots, y_.data(), rows_.data());
  if (!evaluator_.shifts_time()) return true;
  std::fill(shift_rows_.begin(), shift_rows_.end(), 0.0);
  std::array<double, kMaxOutputs> shift{};
  for (int o = 0; o < ny_; ++o) {
    shift[o] = evaluator_.time_shift(y_.data(), o);
    double* by_shift = shift_rows_.data() + static_cast<std::ptrdiff_t>(o) * width_;
    const auto add = [&](const double* port_row) {
      for (int j = 0; j < n_; ++j) by_shift[j] += port_row[j];
      for (int s = 0; s < slots.count(); ++s) by_shift[n_ + slots.column(s)] += port_row[n_ + s];
    };
    add(row(ny_));
    if (evaluator_.shifts_apart()) add(row(ny_ + 1 + o));
  }
  slots.clear();
  for (int c = 0; c < evaluator_.columns(); ++c) static_cast<void>(slots.slot(c));
  for (int o = 0; o < ny_; ++o) {
    if ((o == 0 || shift[o] != shift[o - 1]) && !carry(run, i, shift[o], x)) return false;
    y_[o] = moved_y_[o];
    write_row(o, slots);
  }
  return true;
}

}  // namespace misfit
