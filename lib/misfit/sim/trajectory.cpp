#include "misfit/sim/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace misfit {
namespace {

/// S⁺ = Φ S + Γ on rows [θ columns | x0 columns], columns + states wide, in place through `work`. Columns go in blocks of kRowPadding.
class Sensitivity {
 public:
  Sensitivity(int states, int columns)
      : n_(states),
        columns_(columns),
        stride_(padded(columns + states)),
        rows_(static_cast<std::size_t>(states * stride_), 0.0),
        work_(rows_.size(), 0.0) {
    for (int i = 0; i < n_; ++i) row(i)[columns_ + i] = 1.0;
  }
  [[nodiscard]] int width() const { return columns_ + n_; }
  [[nodiscard]] const double* row(int i) const { return rows_.data() + static_cast<std::ptrdiff_t>(i) * stride_; }
  [[nodiscard]] RowMatrix matrix() const {
    return Eigen::Map<const RowMatrix, 0, Eigen::OuterStride<>>(rows_.data(), n_, width(), Eigen::OuterStride<>(stride_));
  }

  void advance(const double* D, const Slots& slots) {
    for (int i = 0; i < n_; ++i) {
      combine(D + static_cast<std::ptrdiff_t>(i) * kRowStride, slots, work_.data() + static_cast<std::ptrdiff_t>(i) * stride_);
    }
    rows_.swap(work_);
  }
  /// out = (state part of `D`) · S + (slot part of `D`) scattered; out has a whole number of blocks.
  void combine(const double* D, const Slots& slots, double* out) const {
    switch (n_) {  // the number of states of the usual systems is given to the compiler; 0: any
      case 2:
        multiply<2>(D, out);
        break;
      case 4:
        multiply<4>(D, out);
        break;
      default:
        multiply<0>(D, out);
    }
    for (int s = 0; s < slots.count(); ++s) out[slots.column(s)] += D[n_ + s];
  }
  /// Adds speed ⊗ direction: the state also moves with the shift of the sample time.
  void add_direction(const double* speed, const double* direction) {
    for (int i = 0; i < n_; ++i) {
      for (int c = 0; c < width(); ++c) row(i)[c] += speed[i] * direction[c];
    }
  }
  [[nodiscard]] std::vector<double> empty_row() const { return std::vector<double>(static_cast<std::size_t>(stride_)); }

 private:
  using Block = Eigen::Array<double, kRowPadding, 1>;
  double* row(int i) { return rows_.data() + static_cast<std::ptrdiff_t>(i) * stride_; }

  template <int N>
  void multiply(const double* weights, double* out) const {
    const int n = N > 0 ? N : n_;
    const double* S = rows_.data();
    for (int c = 0; c < stride_; c += kRowPadding) {
      Block sum = weights[0] * Eigen::Map<const Block>(S + c);
      for (int j = 1; j < n; ++j) sum += weights[j] * Eigen::Map<const Block>(S + static_cast<std::ptrdiff_t>(j) * stride_ + c);
      Eigen::Map<Block>(out + c) = sum;
    }
  }

  int n_, columns_, stride_;
  std::vector<double> rows_, work_;
};

struct Scratch {
  std::vector<double> D, O, row;
  Slots slots;
  std::array<double, kMaxOutputs + 1> y{};
};

/// From the time of sample i to the shifted one: the parts of the interval beside it are fine enough for what is shorter.
Interval shifted_interval(const Signals& signals, const InputTable& inputs, std::size_t i, double shift) {
  Interval out{signals.t[i], signals.t[i] + shift, inputs.at(i), inputs.at(i)};
  if (i + 1 < signals.samples() && std::abs(shift) <= signals.t[i + 1] - signals.t[i]) {
    out.parts = inputs.plan.of(i);
    out.rate = inputs.plan.rate_at(i);
  }
  return out;
}

double* output_row(std::size_t i, int o, int outputs, Segment& out) {
  return out.y_rows.row(static_cast<Eigen::Index>((i - out.first) * static_cast<std::size_t>(outputs)) + o).data();
}

/// Outputs that are states as they stand: their rows are those of S.
void copy_states(const Evaluator& evaluator, const double* x, const Sensitivity& S, double* y, double* rows) {
  for (int o = 0; o < evaluator.outputs(); ++o) {
    y[o] = x[evaluator.observed(o)];
    std::copy_n(S.row(evaluator.observed(o)), S.width(), rows + static_cast<std::ptrdiff_t>(o) * S.width());
  }
}

/// Rows of ∂y/∂(θ, x0) at sample i into out.y_rows.
bool predict_linear(Stepper& stepper, const Signals& signals, const InputTable& inputs, std::size_t i, const double* x,
                    const Sensitivity& S, Scratch& w, Segment& out) {
  Evaluator& evaluator = stepper.evaluator();
  const int ny = evaluator.outputs(), n = stepper.states();
  if (evaluator.outputs_are_states()) {
    copy_states(evaluator, x, S, w.y.data(), output_row(i, 0, ny, out));
    return true;
  }
  w.slots.clear();
  evaluator.linearise_outputs(x, inputs.at(i), signals.t[i], w.slots, w.y.data(), w.O.data());
  const double shift = evaluator.shifts_time() ? w.y[static_cast<std::size_t>(ny)] : 0.0;
  std::optional<Sensitivity> moved_S;
  const Sensitivity* use = &S;
  if (evaluator.shifts_time()) {
    std::vector<double> by_shift = S.empty_row();
    S.combine(w.O.data() + static_cast<std::ptrdiff_t>(ny) * kRowStride, w.slots, by_shift.data());  // ∂τ/∂(θ, x0)
    std::array<double, kMaxStates> moved, speed{};
    std::copy_n(x, n, moved.begin());
    if (!stepper.step_linear(moved.data(), shifted_interval(signals, inputs, i, shift), w.slots, w.D.data())) return false;
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
    use->combine(w.O.data() + static_cast<std::ptrdiff_t>(o) * kRowStride, w.slots, w.row.data());
    std::copy_n(w.row.data(), S.width(), output_row(i, o, ny, out));
  }
  return true;
}

}  // namespace

Interval interval_between(const Signals& signals, const InputTable& inputs, std::size_t i) {
  return {signals.t[i], signals.t[i + 1], inputs.at(i), inputs.at(i + 1), inputs.plan.of(i), inputs.plan.rate_at(i)};
}

void prepare_at(Stepper& stepper, const Signals& signals, const InputTable& inputs, std::size_t i, const double* x) {
  constexpr double unplanned = std::numeric_limits<double>::infinity();
  stepper.prepare(x, inputs.at(i), signals.t[i], i < inputs.plan.rate.size() ? inputs.plan.rate[i] : unplanned);
}

bool predict_at(Stepper& stepper, const Signals& signals, const InputTable& inputs, std::size_t i, const double* x, double* y) {
  Evaluator& evaluator = stepper.evaluator();
  evaluator.predict(x, inputs.at(i), signals.t[i], y);
  const double shift = evaluator.shifts_time() ? y[evaluator.outputs()] : 0.0;
  if (shift == 0.0) return true;
  std::array<double, kMaxStates> moved;
  std::copy_n(x, stepper.states(), moved.begin());
  if (!stepper.step(moved.data(), shifted_interval(signals, inputs, i, shift))) return false;
  evaluator.predict(moved.data(), inputs.at(i), signals.t[i], y);
  return true;
}

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

void run_in_batches(Stepper& stepper, const Signals& signals, const InputTable& inputs, std::size_t first, std::size_t last,
                    const double* x0, bool sensitivities, std::size_t batch, Segment& out, const std::function<void(Segment&)>& take) {
  Evaluator& evaluator = stepper.evaluator();
  const int n = stepper.states(), ny = evaluator.outputs(), columns = evaluator.columns();
  Scratch w;
  w.D.resize(static_cast<std::size_t>(n) * kRowStride);
  w.O.resize(static_cast<std::size_t>(ny + 1) * kRowStride);
  Sensitivity S(n, sensitivities ? columns : 0);
  w.row = S.empty_row();
  std::array<double, kMaxStates> x{};
  std::copy_n(x0, n, x.begin());
  prepare_at(stepper, signals, inputs, first, x.data());
  // Rows copied from S need no look of their own: what is not finite in S stays so up to the end.
  const bool rows_differ = sensitivities && !evaluator.outputs_are_states();
  const auto begin_batch = [&](std::size_t from) {
    out.first = from;
    out.last = std::min(from + batch, last);
    const auto samples = static_cast<Eigen::Index>(out.last - out.first);
    out.y.resize(samples, ny);
    if (sensitivities) out.y_rows.resize(samples * ny, columns + n);
  };
  out.finite = false;
  begin_batch(first);
  for (std::size_t i = first; i < last; ++i) {
    out.failed_at = i;
    const bool predicted = sensitivities ? predict_linear(stepper, signals, inputs, i, x.data(), S, w, out)
                                         : predict_at(stepper, signals, inputs, i, x.data(), w.y.data());
    if (!predicted) return;
    std::copy_n(w.y.data(), ny, out.y.row(static_cast<Eigen::Index>(i - out.first)).data());
    if (i + 1 == out.last) {
      if (!out.y.allFinite() || (rows_differ && !out.y_rows.allFinite())) return;
      take(out);
      if (i + 1 < last) begin_batch(i + 1);
    }
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
  if (sensitivities) out.end_rows = S.matrix();
  out.finite = !sensitivities || out.end_rows.allFinite();
}

void run_segment(Stepper& stepper, const Signals& signals, const InputTable& inputs, std::size_t first, std::size_t last, const double* x0,
                 bool sensitivities, Segment& out) {
  run_in_batches(stepper, signals, inputs, first, last, x0, sensitivities, last - first, out, [](Segment&) {});
}

RowMatrix run_states(Stepper& stepper, const Signals& signals, const InputTable& inputs, std::size_t first, std::size_t last,
                     const double* x0) {
  const int n = stepper.states();
  RowMatrix states(static_cast<Eigen::Index>(last - first), n);
  std::array<double, kMaxStates> x{};
  std::copy_n(x0, n, x.begin());
  prepare_at(stepper, signals, inputs, first, x.data());
  for (std::size_t i = first; i < last; ++i) {
    std::copy_n(x.begin(), n, states.row(static_cast<Eigen::Index>(i - first)).data());
    if (i + 1 < last && !stepper.step(x.data(), interval_between(signals, inputs, i))) {
      return states.topRows(static_cast<Eigen::Index>(i - first) + 1);
    }
  }
  return states;
}

}  // namespace misfit
