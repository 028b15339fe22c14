#include "misfit/inference/own_states.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "misfit/math/decompositions.h"
#include "misfit/model/evaluator.h"
#include "misfit/model/memory.h"
#include "misfit/sim/trajectory.h"

namespace misfit {
namespace {

constexpr double singular = 1e-9;  // reciprocal condition
constexpr double constant = 1e-6;  // relative change of A along the motion

/// The own states of one effect, whose dynamics are linear with the constant matrix A.
struct Memory {
  Eigen::Index first = 0;  ///< of its own states in the model's
  Eigen::MatrixXd A;
  RowMatrix rest;                 ///< samples × states, where the sample is known
  Eigen::MatrixXd rest_by_state;  ///< states × system states, at the first known sample
};

Eigen::Index first_known(const ReconstructedStates& states) {
  const auto known = std::find(states.ok.begin(), states.ok.end(), true);
  return known == states.ok.end() ? 0 : known - states.ok.begin();
}

/// Which of the model's states are the own states of an effect.
struct Block {
  Eigen::Index first = 0, size = 0;
};

struct Recording {
  const Model& model;
  const Signals& signals;
  const ReconstructedStates& states;
  const InputTable& inputs;
};

/// Drifts and their derivatives along the motion, with own states fixed.
class Along {
 public:
  explicit Along(const Recording& recording)
      : model_(recording.model),
        signals_(recording.signals),
        states_(recording.states),
        inputs_(recording.inputs),
        evaluator_(model_),
        first_(first_known(states_)),
        at_(Eigen::VectorXd::Zero(model_.states())),
        dx_(model_.states()),
        D_(model_.states() * kRowStride) {
    set_system_states(first_);
    set_own_states_at_rest(model_, inputs_.at(first_), signals_.t[first_], at_);
    const Eigen::Index system = model_.system_states();
    own_ = at_.tail(at_.size() - system);
    for (const BoundEffect& effect : model_.effects) {
      const EffectSpec& spec = effect.effect->spec();
      const auto size = std::ssize(spec.states);
      if (size == 0 || spec.quantities.empty()) continue;  // what reads nothing (a random force) remembers nothing of the motion
      const Eigen::Index first = system + effect.first_state;
      if (only_adds_up(*effect.effect)) {
        counters_.push_back({first, size});
      } else {
        memories_.push_back({first, Eigen::MatrixXd::Zero(size, size), RowMatrix::Zero(states_.x.rows(), size), {}});
      }
    }
  }

  /// Those with constant A.
  [[nodiscard]] std::vector<Memory> memories() {
    if (memories_.empty()) return {};
    std::vector<bool> linear(memories_.size(), true);
    for (Eigen::Index i = first_; i < states_.x.rows(); ++i) {
      if (!states_.ok[i]) continue;
      set_system_states(i);
      linearise(inputs_.at(i), signals_.t[i]);
      for (std::size_t m = 0; m < memories_.size(); ++m) linear[m] = linear[m] && take(memories_[m], i);
    }
    std::vector<Memory> out;
    for (std::size_t m = 0; m < memories_.size(); ++m) {
      if (linear[m]) out.push_back(memories_[m]);
    }
    for (std::size_t m = 0; m < memories_.size(); ++m) {
      if (!linear[m]) nonlinear_.push_back({memories_[m].first, memories_[m].A.rows()});
    }
    return out;
  }

  [[nodiscard]] const Eigen::VectorXd& at_rest() const { return own_; }
  /// Own states of effects whose dynamics are not linear, as memories() found.
  [[nodiscard]] const std::vector<Block>& nonlinear() const { return nonlinear_; }
  /// Of those that only add up what they read: they begin where the effect says.
  [[nodiscard]] const std::vector<Block>& counters() const { return counters_; }

  /// Own states where these two, begun as `start` has them (all own states), follow the motion, and the others stay: from sample
  /// to sample two exponential Euler steps (Hochbruck and Ostermann 2010, exponential Rosenbrock-Euler), each with the motion and the
  /// inputs of its middle. They stay while the motion is not known. NaN where they diverge.
  [[nodiscard]] RowMatrix followed(const Eigen::VectorXd& start) {
    RowMatrix out = start.transpose().replicate(states_.x.rows(), 1);
    at_.tail(start.size()) = start;
    for (Eigen::Index i = first_; i + 1 < out.rows(); ++i) {
      if (states_.ok[i] && states_.ok[i + 1]) {
        for (const double share : {0.25, 0.75}) step(i, share);
      }
      out.row(i + 1) = at_.tail(start.size()).transpose();
    }
    return out;
  }

 private:
  using Derivatives = Eigen::Map<const RowMatrix, 0, Eigen::OuterStride<>>;
  /// Of the rates, by the states, where they were linearised last.
  [[nodiscard]] Derivatives derivatives() const { return {D_.data(), model_.states(), model_.states(), Eigen::OuterStride<>(kRowStride)}; }
  void linearise(const InputsAt& u, double t) { evaluator_.linearise_rates({at_.data(), u, t}, slots_, dx_.data(), D_.data()); }

  /// Half of the way from a sample to the next, with what is at a share of it.
  void step(Eigen::Index sample, double share) {
    const Eigen::Index system = model_.system_states();
    const double length = signals_.t[sample + 1] - signals_.t[sample];
    at_.head(system) = ((1.0 - share) * states_.x.row(sample).head(system) + share * states_.x.row(sample + 1).head(system)).transpose();
    const std::vector<double> u = inputs_within(inputs_, sample, share, length);
    linearise({u.data(), &inputs_.recorded}, signals_.t[sample] + share * length);
    for (const auto* blocks : {&nonlinear_, &counters_}) {
      for (const Block& block : *blocks) at_.segment(block.first, block.size) += increment(block, 0.5 * length);
    }
  }

  /// h phi_1(A h) z': the last column of the exponential of [A z'; 0 0] h.
  [[nodiscard]] Eigen::VectorXd increment(const Block& block, double h) const {
    Eigen::MatrixXd augmented = Eigen::MatrixXd::Zero(block.size + 1, block.size + 1);
    augmented.topLeftCorner(block.size, block.size) = h * derivatives().block(block.first, block.first, block.size, block.size);
    augmented.topRightCorner(block.size, 1) = h * Eigen::Map<const Eigen::VectorXd>(dx_.data() + block.first, block.size);
    return exponential(augmented).topRightCorner(block.size, 1);
  }

  void set_system_states(Eigen::Index sample) {
    at_.head(model_.system_states()) = states_.x.row(sample).head(model_.system_states()).transpose();
  }

  /// False if the effect's own dynamics are not linear with the A of the first sample.
  bool take(Memory& memory, Eigen::Index sample) const {
    const Eigen::Index size = memory.A.rows();
    const Derivatives rows = derivatives();
    const Eigen::MatrixXd A = rows.block(memory.first, memory.first, size, size);
    if (sample == first_) memory.A = A;
    if (!((A - memory.A).norm() <= constant * memory.A.norm())) return false;
    Eigen::MatrixXd known(size, 1 + model_.system_states());  // drift, and its derivatives by the states of the system
    known << Eigen::Map<const Eigen::VectorXd>(dx_.data() + memory.first, size), rows.block(memory.first, 0, size, model_.system_states());
    const std::optional<Eigen::MatrixXd> solved = solve(A, known, singular);
    if (!solved) return false;
    if (sample == first_) memory.rest_by_state = -solved->rightCols(model_.system_states());
    memory.rest.row(sample) = (at_.segment(memory.first, size) - solved->col(0)).transpose();
    return memory.rest.row(sample).allFinite();
  }

  const Model& model_;
  const Signals& signals_;
  const ReconstructedStates& states_;
  const InputTable& inputs_;
  Evaluator evaluator_;
  Eigen::Index first_;
  Eigen::VectorXd at_, own_;
  Slots slots_;
  std::vector<double> dx_, D_;
  std::vector<Memory> memories_;
  std::vector<Block> nonlinear_, counters_;
};

/// d' = A d - r' from sample to sample; at rest again after samples that are not known.
RowMatrix departures(const Memory& memory, const Recording& recording, const Eigen::VectorXd& start) {
  const ReconstructedStates& states = recording.states;
  const Eigen::Index size = memory.A.rows();
  RowMatrix d = RowMatrix::Zero(memory.rest.rows(), size);
  const Eigen::MatrixXd inverse_of_A = inverse(memory.A);
  Eigen::MatrixXd carried;
  double step = -1.0;
  const Eigen::Index first = first_known(states);
  d.row(first) = start.transpose();
  for (Eigen::Index i = first; i + 1 < d.rows(); ++i) {
    if (!states.ok[i] || !states.ok[i + 1]) continue;
    const double h = recording.signals.t[i + 1] - recording.signals.t[i];
    if (std::abs(h - step) > 1e-9 * h) carried = exponential(memory.A * h), step = h;
    const Eigen::VectorXd rate = (memory.rest.row(i + 1) - memory.rest.row(i)).transpose() / h;
    d.row(i + 1) = (carried * d.row(i).transpose() - inverse_of_A * (carried * rate - rate)).transpose();
  }
  return d;
}

/// Samples that do not remember how the memory was begun.
std::vector<Eigen::Index> settled(const Memory& memory, const Signals& signals, const ReconstructedStates& states) {
  const Eigen::VectorXcd poles = eigenvalues(memory.A);
  const double slowest = -poles.real().maxCoeff();
  const Eigen::Index first = first_known(states);
  const double length = signals.t.back() - signals.t[first];
  const double forgotten = slowest > 0.0 ? std::min(3.0 / slowest, 0.5 * length) : 0.5 * length;
  std::vector<Eigen::Index> out;
  double begun = signals.t[first];
  for (Eigen::Index i = first; i < states.x.rows(); ++i) {
    if (!states.ok[i] && static_cast<std::size_t>(i) + 1 < signals.t.size()) begun = signals.t[i + 1];
    if (states.ok[i] && !signals.held_out(i) && signals.t[i] - begun >= forgotten) out.push_back(i);
  }
  return out;
}

/// 1, the states of the system that are shown, their derivatives, the inputs.
Eigen::VectorXd regressors(const Recording& recording, Eigen::Index sample) {
  const auto& [model, signals, states, inputs] = recording;
  std::vector<double> out{1.0};
  for (Eigen::Index j = 0; j < model.system_states(); ++j) {
    if (!states.shown[j]) continue;
    out.push_back(states.x(sample, j));
    out.push_back(states.dx(sample, j));
  }
  const double* u = inputs.at(sample).values;
  out.insert(out.end(), u, u + model.inputs());
  return Eigen::Map<const Eigen::VectorXd>(out.data(), std::ssize(out));
}

/// The same at several samples, a row each.
Eigen::MatrixXd regressors(const Recording& recording, const std::vector<Eigen::Index>& samples) {
  Eigen::MatrixXd out;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Eigen::VectorXd row = regressors(recording, samples[k]);
    if (k == 0) out.resize(std::ssize(samples), row.size());
    out.row(static_cast<Eigen::Index>(k)) = row.transpose();
  }
  return out;
}

/// Least squares of `values` on what is `known` at the same samples; none if these are too few.
std::optional<Eigen::MatrixXd> regression(const Eigen::MatrixXd& known, const RowMatrix& values) {
  constexpr Eigen::Index samples_per_coefficient = 5;
  if (known.rows() < samples_per_coefficient * known.cols()) return std::nullopt;
  Eigen::VectorXd scale = known.colwise().norm();
  for (double& s : scale) s = s > 0.0 ? s : 1.0;
  constexpr double dependent = 1e-6;
  const Eigen::MatrixXd scaled = least_squares(known * scale.cwiseInverse().asDiagonal(), values, dependent);
  const Eigen::MatrixXd out = scale.cwiseInverse().asDiagonal() * scaled;
  return out.allFinite() ? std::optional<Eigen::MatrixXd>(out) : std::nullopt;
}

/// One effect's memory along the motion, written into its columns.
void fill(const Memory& memory, const Recording& recording, OwnStates& out) {
  const auto& [model, signals, states, inputs] = recording;
  const Eigen::Index size = memory.A.rows(), at = memory.first - model.system_states(), first = first_known(states);
  const std::vector<Eigen::Index> samples = settled(memory, signals, states);
  if (samples.empty()) return;
  const RowMatrix begun_at_rest = departures(memory, recording, Eigen::VectorXd::Zero(size));
  const Eigen::VectorXd at_first = regressors(recording, first);
  const RowMatrix values = begun_at_rest(samples, Eigen::all);
  const Eigen::MatrixXd known = regressors(recording, samples);
  const Eigen::VectorXd sigma = (values.colwise().squaredNorm() / static_cast<double>(values.rows())).cwiseSqrt().transpose();
  const std::optional<Eigen::MatrixXd> coefficients = regression(known, values);
  Eigen::VectorXd start = coefficients ? Eigen::VectorXd(coefficients->transpose() * at_first) : Eigen::VectorXd::Zero(size);
  constexpr double farthest = 3.0;  // sigmas: no extrapolation
  start = start.cwiseMin(farthest * sigma).cwiseMax(-farthest * sigma);
  const RowMatrix d = departures(memory, recording, start);
  for (Eigen::Index i = first; i < d.rows(); ++i) {
    if (states.ok[i]) out.z.row(i).segment(at, size) = memory.rest.row(i) + d.row(i);
  }
  out.start.segment(at, size) = out.z.row(first).segment(at, size).transpose();
  out.sigma.segment(at, size) = sigma;
  for (Eigen::Index j = 0; j < model.system_states(); ++j) {
    if (!states.shown[j]) out.by_hidden_states.block(at, j, size, 1) = memory.rest_by_state.col(j);
  }
}

/// Samples known and of the fit in the later half of the recording, where the beginning is forgotten.
std::vector<Eigen::Index> later_half(const Recording& recording) {
  const auto& [model, signals, states, inputs] = recording;
  std::vector<Eigen::Index> out;
  const Eigen::Index first = first_known(states);
  const double middle = 0.5 * (signals.t[first] + signals.t.back());
  for (Eigen::Index i = first; i < states.x.rows(); ++i) {
    if (states.ok[i] && !signals.held_out(i) && signals.t[i] >= middle) out.push_back(i);
  }
  return out;
}

/// What the motion at the first sample says of own states: the prediction from the motion, learnt from `values` (samples × own states) at
/// `samples`, and its largest error there, for a recording may begin where it errs most (on the way to a new command). Their mean and
/// largest departure from it where these are too few.
struct Beginning {
  Eigen::VectorXd start, sigma;
};

Beginning beginning(const Recording& recording, const std::vector<Eigen::Index>& samples, const RowMatrix& values) {
  const Eigen::VectorXd at = regressors(recording, first_known(recording.states));
  const Eigen::MatrixXd known = regressors(recording, samples);
  const Eigen::RowVectorXd mean = values.colwise().mean();
  const RowMatrix departures = values.rowwise() - mean;
  const auto largest = [](const RowMatrix& rows) -> Eigen::VectorXd { return rows.cwiseAbs().colwise().maxCoeff().transpose(); };
  const std::optional<Eigen::MatrixXd> coefficients = regression(known, departures);
  if (!coefficients) return {mean.transpose(), largest(departures)};
  return {mean.transpose() + coefficients->transpose() * at, largest(departures - known * *coefficients)};
}

/// Where memories that are not linear begin, and how uncertain that is. False: not to be told.
bool begin_nonlinear(Along& along, const Recording& recording, OwnStates& out) {
  if (along.nonlinear().empty()) return true;
  const std::vector<Eigen::Index> samples = later_half(recording);
  if (samples.empty()) return false;
  const RowMatrix begun_at_rest = along.followed(out.start);
  for (const Block& block : along.nonlinear()) {
    const Eigen::Index at = block.first - recording.model.system_states();
    const RowMatrix values = begun_at_rest(samples, Eigen::seqN(at, block.size));
    if (!values.allFinite()) return false;
    const Beginning begun = beginning(recording, samples, values);
    const Eigen::VectorXd least = values.colwise().minCoeff().transpose(), largest = values.colwise().maxCoeff().transpose();
    out.start.segment(at, block.size) = begun.start.cwiseMax(least).cwiseMin(largest);  // no extrapolation
    out.sigma.segment(at, block.size) = begun.sigma.cwiseMin(largest - least);
  }
  return true;
}

/// Memories that are not linear, and what counts from its beginning, written into their columns.
void follow(Along& along, const Recording& recording, OwnStates& out) {
  if (along.nonlinear().empty() && along.counters().empty()) return;
  const bool begun = begin_nonlinear(along, recording, out);
  const RowMatrix z = along.followed(out.start);
  const auto write = [&](const std::vector<Block>& blocks) {
    for (const Block& block : blocks) {
      const Eigen::Index at = block.first - recording.model.system_states();
      if (z.middleCols(at, block.size).allFinite()) out.z.middleCols(at, block.size) = z.middleCols(at, block.size);
    }
  };
  if (begun) write(along.nonlinear());
  write(along.counters());
}

}  // namespace

OwnStates own_states_along(const Model& model, const Signals& signals, const ReconstructedStates& states) {
  const auto own = std::ssize(model.own_states);
  OwnStates out{RowMatrix::Zero(states.x.rows(), own), Eigen::VectorXd::Zero(own), Eigen::VectorXd::Zero(own),
                Eigen::MatrixXd::Zero(own, model.system_states())};
  if (own == 0 || states.x.rows() == 0) return out;
  const InputTable inputs = input_table(signals, model);
  const Recording recording{model, signals, states, inputs};
  Along along(recording);
  out.start = along.at_rest();
  out.z.rowwise() = out.start.transpose();
  for (const Memory& memory : along.memories()) fill(memory, recording, out);
  follow(along, recording, out);
  return out;
}

}  // namespace misfit
