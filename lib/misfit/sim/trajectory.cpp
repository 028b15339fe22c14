#include "misfit/sim/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "misfit/core/lists.h"
#include "misfit/sim/sampled_outputs.h"

namespace misfit {
namespace {

/// S⁺ = Φ S + Γ on rows [θ columns | x0 columns], columns + states wide, in place through `work`. Columns go in blocks of kRowPadding.
class Sensitivity {
 public:
  Sensitivity(int states, int columns)
      : n_(states), columns_(columns), stride_(padded(columns + states)), rows_(states * stride_, 0.0), work_(rows_.size(), 0.0) {
    for (int i = 0; i < n_; ++i) row(i)[columns_ + i] = 1.0;
  }
  [[nodiscard]] int width() const { return columns_ + n_; }
  [[nodiscard]] const double* row(int i) const { return rows_.data() + i * stride_; }
  [[nodiscard]] RowMatrix matrix() const {
    return Eigen::Map<const RowMatrix, 0, Eigen::OuterStride<>>(rows_.data(), n_, width(), Eigen::OuterStride<>(stride_));
  }

  void advance(const double* D, const Slots& slots) {
    for (int i = 0; i < n_; ++i) combine(D + i * kRowStride, slots, work_.data() + i * stride_);
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
  [[nodiscard]] std::vector<double> empty_row() const { return std::vector<double>(stride_); }

 private:
  using Block = Eigen::Array<double, kRowPadding, 1>;
  double* row(int i) { return rows_.data() + i * stride_; }

  template <int N>
  void multiply(const double* weights, double* out) const {
    const int n = N > 0 ? N : n_;
    const double* S = rows_.data();
    for (std::ptrdiff_t c = 0; c < stride_; c += kRowPadding) {
      Block sum = weights[0] * Eigen::Map<const Block>(S + c);
      for (int j = 1; j < n; ++j) sum += weights[j] * Eigen::Map<const Block>(S + j * stride_ + c);
      Eigen::Map<Block>(out + c) = sum;
    }
  }

  int n_, columns_;
  std::ptrdiff_t stride_;
  std::vector<double> rows_, work_;
};

/// A run as it stands at a sample, and scratch memory.
struct StretchState {
  std::array<double, kMaxStates> x{};
  Sensitivity S;  ///< ∂x/∂(θ, x0)
  std::vector<double> D, row;
  Slots slots;
  std::array<double, kMaxSensorPorts> y{};
  SampledOutputs outputs;

  StretchState(const Simulation& simulation, const Stretch& stretch)
      : S(simulation.stepper.states(), stretch.sensitivities ? simulation.stepper.evaluator().columns() : 0),
        D(simulation.stepper.states() * kRowStride),
        row(S.empty_row()),
        outputs(simulation.stepper) {
    std::copy_n(stretch.x0, simulation.stepper.states(), x.begin());
    prepare_at(simulation, stretch.first, x.data());
  }
};

double* output_row(std::size_t i, int o, int outputs, Segment& out) { return out.y_rows.row((i - out.first) * outputs + o).data(); }

/// Outputs that are states as they stand: their rows are those of S.
void copy_states(const Evaluator& evaluator, StretchState& at, double* rows) {
  const Sensitivity& S = at.S;
  for (int o = 0; o < evaluator.outputs(); ++o) {
    at.y[o] = at.x[evaluator.observed(o)];
    std::copy_n(S.row(evaluator.observed(o)), S.width(), rows);
    rows += S.width();
  }
}

/// Rows of ∂y/∂(θ, x0) at sample i into out.y_rows.
bool predict_linear(const Simulation& simulation, std::size_t i, StretchState& at, Segment& out) {
  Evaluator& evaluator = simulation.stepper.evaluator();
  const int ny = evaluator.outputs();
  if (evaluator.outputs_are_states()) {
    copy_states(evaluator, at, output_row(i, 0, ny, out));
    return true;
  }
  if (!at.outputs.linearise(simulation, i, at.x.data(), at.slots)) return false;
  for (int o = 0; o < ny; ++o) {
    at.y[o] = at.outputs.y(o);
    at.S.combine(at.outputs.row(o), at.slots, at.row.data());
    std::copy_n(at.row.data(), at.S.width(), output_row(i, o, ny, out));
  }
  return true;
}

}  // namespace

std::vector<double> inputs_within(const InputTable& inputs, std::size_t sample, double share, double length) {
  std::vector<double> out;
  for (int i = 0; i < std::ssize(inputs.recorded.hold); ++i)
    out.push_back(input_within(inputs.recorded.hold[i], inputs.at(sample), inputs.at(sample + 1), i, share, length).value);
  return out;
}

Interval interval_after(const Simulation& run, std::size_t i) {
  const auto& [stepper, signals, inputs] = run;
  return {signals.t[i], signals.t[i + 1], inputs.at(i), inputs.at(i + 1), inputs.plan.of(i), inputs.plan.rate_at(i)};
}

void prepare_at(const Simulation& run, std::size_t i, const double* x) {
  const auto& [stepper, signals, inputs] = run;
  const bool planned = i < inputs.plan.rate.size();
  stepper.prepare(x, inputs.at(i), signals.t[i], planned ? inputs.plan.rate[i] : std::numeric_limits<double>::infinity());
}

InputTable input_table(const Signals& signals, const Model& model) {
  RecordedInputs recorded{signals.t, {}, {}};
  for (const InputSpec& input : model.system->spec().inputs) recorded.hold.push_back(input.hold);
  const std::size_t stride = recorded.stride();
  recorded.values.assign(signals.samples() * stride, 0.0);
  for (std::size_t k = 0; k < std::min(signals.inputs.size(), recorded.hold.size()); ++k) {
    if (signals.inputs[k].values.size() != signals.samples()) continue;  // an input nobody needs
    for (std::size_t i = 0; i < signals.samples(); ++i) recorded.values[i * stride + k] = signals.inputs[k].values[i];
  }
  set_slopes(recorded);
  return {std::move(recorded), {}};
}

void run_in_batches(const Simulation& simulation, const Stretch& stretch, Segment& out, const std::function<void(Segment&)>& take) {
  const auto& [first, last, x0, sensitivities, batch] = stretch;
  Stepper& stepper = simulation.stepper;
  const int n = stepper.states(), ny = stepper.evaluator().outputs();
  StretchState at(simulation, stretch);
  // Rows copied from S need no look of their own: what is not finite in S stays so up to the end.
  const bool rows_differ = sensitivities && !stepper.evaluator().outputs_are_states();
  const auto begin_batch = [&](std::size_t from) {
    out.first = from;
    out.last = stretch.batch > 0 ? std::min(from + stretch.batch, stretch.last) : stretch.last;
    const Eigen::Index samples = out.last - out.first;
    out.y.resize(samples, ny);
    if (stretch.sensitivities) out.y_rows.resize(samples * ny, at.S.width());
  };
  out.finite = false;
  begin_batch(first);
  for (std::size_t i = first; i < last; ++i) {
    out.failed_at = i;
    const bool predicted = sensitivities ? predict_linear(simulation, i, at, out) : predict_at(simulation, i, at.x.data(), at.y.data());
    if (!predicted) return;
    std::copy_n(at.y.data(), ny, out.y.row(i - out.first).data());
    if (i + 1 == out.last) {
      if (!out.y.allFinite() || (rows_differ && !out.y_rows.allFinite())) return;
      take(out);
      if (i + 1 < last) begin_batch(i + 1);
    }
    if (i + 1 >= simulation.signals.samples()) break;
    out.failed_at = i + 1;
    const Interval interval = interval_after(simulation, i);
    if (!sensitivities) {
      if (!stepper.step(at.x.data(), interval)) return;
      continue;
    }
    if (!stepper.step_linear(at.x.data(), interval, at.slots, at.D.data())) return;
    at.S.advance(at.D.data(), at.slots);
  }
  out.end = Eigen::Map<const Eigen::VectorXd>(at.x.data(), n);
  if (sensitivities) out.end_rows = at.S.matrix();
  out.finite = !sensitivities || out.end_rows.allFinite();
}

void run_segment(const Simulation& simulation, const Stretch& stretch, Segment& out) {
  Stretch whole = stretch;
  whole.batch = 0;
  run_in_batches(simulation, whole, out, [](Segment&) {});
}

RowMatrix run_states(const Simulation& simulation, const Stretch& stretch) {
  Stepper& stepper = simulation.stepper;
  const int n = stepper.states();
  RowMatrix states(stretch.last - stretch.first, n);
  std::array<double, kMaxStates> x{};
  std::copy_n(stretch.x0, n, x.begin());
  prepare_at(simulation, stretch.first, x.data());
  for (std::size_t i = stretch.first; i < stretch.last; ++i) {
    std::copy_n(x.begin(), n, states.row(i - stretch.first).data());
    if (i + 1 < stretch.last && !stepper.step(x.data(), interval_after(simulation, i))) return states.topRows(i - stretch.first + 1);
  }
  return states;
}

}  // namespace misfit
