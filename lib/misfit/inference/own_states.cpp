#include "misfit/inference/own_states.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <unsupported/Eigen/MatrixFunctions>

#include "misfit/model/evaluator.h"
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
        first_(first_known(states_)),
        at_(Eigen::VectorXd::Zero(model_.states())) {
    set_system_states(first_);
    set_own_states_at_rest(model_, inputs_.at(first_), signals_.t[first_], at_);
    const Eigen::Index system = model_.system_states();
    own_ = at_.tail(at_.size() - system);
    for (const BoundEffect& effect : model_.effects) {
      const EffectSpec& spec = effect.effect->spec();
      const auto size = std::ssize(spec.states);
      if (size > 0 && !spec.quantities.empty())  // what reads nothing (a random force) remembers nothing of the motion
        memories_.push_back({system + effect.first_state, Eigen::MatrixXd::Zero(size, size), RowMatrix::Zero(states_.x.rows(), size), {}});
    }
  }

  /// Those with constant A.
  [[nodiscard]] std::vector<Memory> memories() {
    if (memories_.empty()) return {};
    Evaluator evaluator(model_);
    Slots slots;
    std::vector<double> dx(model_.states()), D(model_.states() * kRowStride);
    std::vector<bool> linear(memories_.size(), true);
    for (Eigen::Index i = first_; i < states_.x.rows(); ++i) {
      if (!states_.ok[i]) continue;
      set_system_states(i);
      evaluator.linearise_rates({at_.data(), inputs_.at(i), signals_.t[i]}, slots, dx.data(), D.data());
      for (std::size_t m = 0; m < memories_.size(); ++m) linear[m] = linear[m] && take(memories_[m], dx, D, i);
    }
    std::vector<Memory> out;
    for (std::size_t m = 0; m < memories_.size(); ++m) {
      if (linear[m]) out.push_back(memories_[m]);
    }
    return out;
  }

  [[nodiscard]] const Eigen::VectorXd& at_rest() const { return own_; }

 private:
  void set_system_states(Eigen::Index sample) {
    at_.head(model_.system_states()) = states_.x.row(sample).head(model_.system_states()).transpose();
  }

  /// False if the effect's own dynamics are not linear with the A of the first sample.
  bool take(Memory& memory, const std::vector<double>& dx, const std::vector<double>& D, Eigen::Index sample) const {
    const Eigen::Index size = memory.A.rows();
    const Eigen::Map<const RowMatrix, 0, Eigen::OuterStride<>> rows(D.data(), model_.states(), model_.states(),
                                                                    Eigen::OuterStride<>(kRowStride));
    const Eigen::MatrixXd A = rows.block(memory.first, memory.first, size, size);
    if (sample == first_) memory.A = A;
    if (!((A - memory.A).norm() <= constant * memory.A.norm())) return false;
    const Eigen::FullPivLU<Eigen::MatrixXd> inverse(A);
    if (!(inverse.rcond() > singular)) return false;
    if (sample == first_) memory.rest_by_state = -inverse.solve(Eigen::MatrixXd(rows.block(memory.first, 0, size, model_.system_states())));
    const Eigen::Map<const Eigen::VectorXd> drift(dx.data() + memory.first, size);
    memory.rest.row(sample) = (at_.segment(memory.first, size) - inverse.solve(drift)).transpose();
    return memory.rest.row(sample).allFinite();
  }

  const Model& model_;
  const Signals& signals_;
  const ReconstructedStates& states_;
  const InputTable& inputs_;
  Eigen::Index first_;
  Eigen::VectorXd at_, own_;
  std::vector<Memory> memories_;
};

/// d' = A d - r' from sample to sample; at rest again after samples that are not known.
RowMatrix departures(const Memory& memory, const Recording& recording, const Eigen::VectorXd& start) {
  const ReconstructedStates& states = recording.states;
  const Eigen::Index size = memory.A.rows();
  RowMatrix d = RowMatrix::Zero(memory.rest.rows(), size);
  const Eigen::MatrixXd inverse = memory.A.inverse();
  Eigen::MatrixXd carried;
  double step = -1.0;
  const Eigen::Index first = first_known(states);
  d.row(first) = start.transpose();
  for (Eigen::Index i = first; i + 1 < d.rows(); ++i) {
    if (!states.ok[i] || !states.ok[i + 1]) continue;
    const double h = recording.signals.t[i + 1] - recording.signals.t[i];
    if (std::abs(h - step) > 1e-9 * h) carried = (memory.A * h).exp(), step = h;
    const Eigen::VectorXd rate = (memory.rest.row(i + 1) - memory.rest.row(i)).transpose() / h;
    d.row(i + 1) = (carried * d.row(i).transpose() - inverse * (carried * rate - rate)).transpose();
  }
  return d;
}

/// Samples that do not remember how the memory was begun.
std::vector<Eigen::Index> settled(const Memory& memory, const Signals& signals, const ReconstructedStates& states) {
  const Eigen::VectorXcd poles = memory.A.eigenvalues();
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

/// The departure that the motion of `sample` goes with, by what it goes with at the others; none if these are too few.
std::optional<Eigen::VectorXd> predicted(const Eigen::MatrixXd& known, const RowMatrix& values, const Eigen::VectorXd& at) {
  constexpr Eigen::Index samples_per_coefficient = 5;
  if (known.rows() < samples_per_coefficient * known.cols()) return std::nullopt;
  Eigen::VectorXd scale = known.colwise().norm();
  for (double& s : scale) s = s > 0.0 ? s : 1.0;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(known * scale.cwiseInverse().asDiagonal());
  qr.setThreshold(1e-6);
  const Eigen::MatrixXd coefficients = qr.solve(Eigen::MatrixXd(values));
  const Eigen::VectorXd out = coefficients.transpose() * scale.cwiseInverse().cwiseProduct(at);
  return out.allFinite() ? std::optional<Eigen::VectorXd>(out) : std::nullopt;
}

/// One effect's memory along the motion, written into its columns.
void fill(const Memory& memory, const Recording& recording, OwnStates& out) {
  const auto& [model, signals, states, inputs] = recording;
  const Eigen::Index size = memory.A.rows(), at = memory.first - model.system_states(), first = first_known(states);
  const std::vector<Eigen::Index> samples = settled(memory, signals, states);
  if (samples.empty()) return;
  const RowMatrix begun_at_rest = departures(memory, recording, Eigen::VectorXd::Zero(size));
  const Eigen::VectorXd beginning = regressors(recording, first);
  RowMatrix values(samples.size(), size);
  Eigen::MatrixXd known(samples.size(), beginning.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Eigen::Index row = k;
    values.row(row) = begun_at_rest.row(samples[k]);
    known.row(row) = regressors(recording, samples[k]).transpose();
  }
  const Eigen::VectorXd sigma = (values.colwise().squaredNorm() / static_cast<double>(values.rows())).cwiseSqrt().transpose();
  Eigen::VectorXd start = predicted(known, values, beginning).value_or(Eigen::VectorXd::Zero(size));
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
  return out;
}

}  // namespace misfit
