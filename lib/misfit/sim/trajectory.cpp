#include "misfit/sim/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace misfit {
namespace {

/// S⁺ = Φ S + Γ on rows [θ columns | x0 columns], width columns + states, in place through `work`.
class Sensitivity {
 public:
  Sensitivity(int states, int columns)
      : n_(states), columns_(columns), width_(columns + states), rows_(RowMatrix::Zero(states, width_)), work_(states, width_) {
    for (int i = 0; i < n_; ++i) rows_(i, columns_ + i) = 1.0;
  }
  const RowMatrix& rows() const { return rows_; }

  void advance(const double* D, const Slots& slots) {
    for (int i = 0; i < n_; ++i) combine(D + static_cast<std::ptrdiff_t>(i) * kRowStride, slots, work_.row(i).data());
    rows_.swap(work_);
  }
  /// out = (state part of `row`) · S + (slot part of `row`) scattered.
  void combine(const double* row, const Slots& slots, double* out) const {
    const double* first = rows_.data();
    for (int c = 0; c < width_; ++c) out[c] = row[0] * first[c];
    for (int j = 1; j < n_; ++j) {
      const double weight = row[j];
      if (weight == 0.0) continue;
      const double* from = first + static_cast<std::ptrdiff_t>(j) * width_;
      for (int c = 0; c < width_; ++c) out[c] += weight * from[c];
    }
    for (int s = 0; s < slots.count(); ++s) out[slots.column(s)] += row[n_ + s];
  }
  /// Adds speed ⊗ direction: the state also moves with the shift of the sample time.
  void add_direction(const double* speed, const double* direction) {
    for (int i = 0; i < n_; ++i) {
      for (int c = 0; c < width_; ++c) rows_(i, c) += speed[i] * direction[c];
    }
  }

 private:
  int n_, columns_, width_;
  RowMatrix rows_, work_;
};

struct Scratch {
  std::vector<double> D, O;
  Slots slots;
  std::array<double, kMaxOutputs + 1> y{};
};

Interval interval_between(const Signals& signals, const InputTable& inputs, std::size_t i) {
  return {signals.t[i], signals.t[i + 1], inputs.at(i), inputs.at(i + 1)};
}

/// Predicted outputs at sample i, at the shifted time where an effect shifts it: the state is carried there by the step map itself.
bool predict(Stepper& stepper, const Signals& signals, const InputTable& inputs, std::size_t i, const double* x, double* y) {
  Evaluator& evaluator = stepper.evaluator();
  evaluator.predict(x, inputs.at(i), signals.t[i], y);
  const double shift = evaluator.shifts_time() ? y[evaluator.outputs()] : 0.0;
  if (shift == 0.0) return true;
  std::array<double, kMaxStates> moved;
  std::copy_n(x, stepper.states(), moved.begin());
  if (!stepper.step(moved.data(), {signals.t[i], signals.t[i] + shift, inputs.at(i), inputs.at(i)})) return false;
  evaluator.predict(moved.data(), inputs.at(i), signals.t[i], y);
  return true;
}

/// Rows of ∂y/∂(θ, x0) at sample i into out.y_rows.
bool predict_linear(Stepper& stepper, const Signals& signals, const InputTable& inputs, std::size_t i, const double* x,
                    const Sensitivity& S, Scratch& w, Segment& out) {
  Evaluator& evaluator = stepper.evaluator();
  const int ny = evaluator.outputs(), n = stepper.states(), columns = evaluator.columns();
  w.slots.clear();
  evaluator.linearise_outputs(x, inputs.at(i), signals.t[i], w.slots, w.y.data(), w.O.data());
  const double shift = evaluator.shifts_time() ? w.y[static_cast<std::size_t>(ny)] : 0.0;
  std::optional<Sensitivity> moved_S;
  const Sensitivity* use = &S;
  if (evaluator.shifts_time()) {
    std::vector<double> by_shift(static_cast<std::size_t>(columns + n));
    S.combine(w.O.data() + static_cast<std::ptrdiff_t>(ny) * kRowStride, w.slots, by_shift.data());  // ∂τ/∂(θ, x0)
    std::array<double, kMaxStates> moved, speed{};
    std::copy_n(x, n, moved.begin());
    if (!stepper.step_linear(moved.data(), {signals.t[i], signals.t[i] + shift, inputs.at(i), inputs.at(i)}, w.slots, w.D.data()))
      return false;
    moved_S = S;
    moved_S->advance(w.D.data(), w.slots);
    // The rate of the motion, where the exact derivative would be that of the step map by its length: equal to the accuracy of a step.
    evaluator.rates(moved.data(), inputs.at(i), signals.t[i] + shift, speed.data());
    moved_S->add_direction(speed.data(), by_shift.data());
    w.slots.clear();
    evaluator.linearise_outputs(moved.data(), inputs.at(i), signals.t[i], w.slots, w.y.data(), w.O.data());
    use = &*moved_S;
  }
  for (int o = 0; o < ny; ++o) {
    const auto r = static_cast<Eigen::Index>((i - out.first) * static_cast<std::size_t>(ny)) + o;
    use->combine(w.O.data() + static_cast<std::ptrdiff_t>(o) * kRowStride, w.slots, out.y_rows.row(r).data());
  }
  return true;
}

}  // namespace

InputTable input_table(const Signals& signals, int inputs) {
  InputTable table;
  table.inputs = inputs;
  const auto stride = static_cast<std::size_t>(inputs > 0 ? inputs : 1);
  table.values.assign(signals.samples() * stride, 0.0);
  for (std::size_t k = 0; k < std::min(signals.inputs.size(), static_cast<std::size_t>(inputs)); ++k) {
    if (signals.inputs[k].values.size() != signals.samples()) continue;  // an input nobody needs
    for (std::size_t i = 0; i < signals.samples(); ++i) table.values[i * stride + k] = signals.inputs[k].values[i];
  }
  return table;
}

void run_segment(Stepper& stepper, const Signals& signals, const InputTable& inputs, std::size_t first, std::size_t last, const double* x0,
                 bool sensitivities, Segment& out) {
  Evaluator& evaluator = stepper.evaluator();
  const int n = stepper.states(), ny = evaluator.outputs(), columns = evaluator.columns();
  const auto samples = static_cast<Eigen::Index>(last - first);
  out.first = first;
  out.last = last;
  out.finite = false;
  out.y.resize(samples, ny);
  if (sensitivities) {
    out.y_rows.resize(samples * ny, columns + n);
  }
  Scratch w;
  w.D.resize(static_cast<std::size_t>(n) * kRowStride);
  w.O.resize(static_cast<std::size_t>(ny + 1) * kRowStride);
  Sensitivity S(n, sensitivities ? columns : 0);
  std::array<double, kMaxStates> x{};
  std::copy_n(x0, n, x.begin());
  stepper.prepare(x.data(), inputs.at(first), signals.t[first]);
  for (std::size_t i = first; i < last; ++i) {
    out.failed_at = i;
    const bool predicted = sensitivities ? predict_linear(stepper, signals, inputs, i, x.data(), S, w, out)
                                         : predict(stepper, signals, inputs, i, x.data(), w.y.data());
    if (!predicted) return;
    for (int o = 0; o < ny; ++o) out.y(static_cast<Eigen::Index>(i - first), o) = w.y[static_cast<std::size_t>(o)];
    if (i + 1 >= signals.samples()) break;
    out.failed_at = i + 1;
    if (!sensitivities) {
      if (!stepper.step(x.data(), interval_between(signals, inputs, i))) return;
      continue;
    }
    if (!stepper.step_linear(x.data(), interval_between(signals, inputs, i), w.slots, w.D.data())) return;
    S.advance(w.D.data(), w.slots);
  }
  out.end = Eigen::Map<const Eigen::VectorXd>(x.data(), n);
  if (sensitivities) {
    out.end_rows = S.rows();
  }
  out.finite = out.y.allFinite() && (!sensitivities || (out.y_rows.allFinite() && out.end_rows.allFinite()));
}

RowMatrix run_states(Stepper& stepper, const Signals& signals, const InputTable& inputs, std::size_t first, std::size_t last,
                     const double* x0) {
  const int n = stepper.states();
  RowMatrix states(static_cast<Eigen::Index>(last - first), n);
  std::array<double, kMaxStates> x{};
  std::copy_n(x0, n, x.begin());
  stepper.prepare(x.data(), inputs.at(first), signals.t[first]);
  for (std::size_t i = first; i < last; ++i) {
    std::copy_n(x.begin(), n, states.row(static_cast<Eigen::Index>(i - first)).data());
    if (i + 1 < last && !stepper.step(x.data(), interval_between(signals, inputs, i))) {
      return states.topRows(static_cast<Eigen::Index>(i - first) + 1);
    }
  }
  return states;
}

}  // namespace misfit
