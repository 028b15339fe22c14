#include "misfit/inference/states.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "misfit/core/watch.h"
#include "misfit/inference/own_states.h"
#include "misfit/inference/solved_states.h"
#include "misfit/math/statistics.h"
#include "misfit/model/evaluator.h"

namespace misfit {
namespace {

struct LocalFit {
  double value, slope, curvature;  // of f, f', f''
  bool ok = false;
};

struct Series {
  const std::vector<double>&t, &y;
  double h;  ///< usual step
};

/// Points within `reach` usual steps.
LocalFit quadratic_within(const Series& series, std::size_t i, std::size_t reach) {
  const auto& [t, y, h] = series;
  Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  int points = 0;
  bool before = false, after = false;
  const std::size_t from = i >= reach ? i - reach : 0, to = std::min(i + reach, t.size() - 1);
  for (std::size_t k = from; k <= to; ++k) {
    const double s = (t[k] - t[i]) / h;
    if (!std::isfinite(y[k]) || std::abs(s) > static_cast<double>(reach) + 1.0) continue;
    const Eigen::Vector3d a(1.0, s, s * s);
    N += a * a.transpose();
    b += a * y[k];
    ++points;
    before = before || k < i;
    after = after || k > i;
  }
  if (points < 4 || !before || !after) return {};
  const Eigen::Vector3d c = N.ldlt().solve(b);
  return {c[0], c[1] / h, 2.0 * c[2] / (h * h), true};
}

LocalFit local_quadratic(const Series& series, std::size_t i) {
  constexpr std::size_t usual = 2, farthest = 4;
  for (std::size_t reach = usual; reach <= farthest; ++reach) {
    const LocalFit fit = quadratic_within(series, i, reach);
    if (fit.ok) return fit;
  }
  return {};
}

/// Fills state and rate from one series of values.
void add_series(const std::vector<StateSpec>& states, int state, const Series& series, ReconstructedStates& out) {
  int rate = -1;
  for (std::size_t j = 0; j < states.size(); ++j) {
    if (states[j].rate_of == state) rate = static_cast<int>(j);
  }
  out.shown[state] = true;
  if (rate >= 0) out.shown[rate] = true;
  for (Eigen::Index i = 0; i < out.x.rows(); ++i) {
    const LocalFit fit = local_quadratic(series, i);
    if (!fit.ok) {
      out.ok[i] = false;
      continue;
    }
    out.x(i, state) = fit.value;
    out.dx(i, state) = fit.slope;
    if (rate < 0) continue;
    out.x(i, rate) = fit.slope;
    out.dx(i, rate) = fit.curvature;
  }
}

/// Values of the readable states at every sample; NaN where a channel is missing or has no such state.
std::vector<std::vector<double>> read_all(const Model& model, const Signals& signals) {
  const auto& readable = model.system->spec().readable_states;
  std::vector<std::vector<double>> out(readable.size(), std::vector<double>(signals.samples(), std::nan("")));
  const std::vector<double> constants = model.values();  // the system's constants come first
  std::array<double, kMaxOutputs> y{};
  std::array<double, kMaxStates> x{};
  for (std::size_t i = 0; i < signals.samples(); ++i) {
    look_at_watch();
    bool known = true;
    for (std::size_t o = 0; o < signals.measured.size(); ++o) {
      y[o] = signals.measured[o].values[i];
      known = known && std::isfinite(y[o]);
    }
    if (!known || !model.system->read_states(y.data(), constants.data(), x.data())) continue;
    for (std::size_t r = 0; r < readable.size(); ++r) out[r][i] = x[readable[r]];
  }
  return out;
}

}  // namespace

double start_of(const StateSpec& state) {
  if (std::isfinite(state.start)) return state.start;
  if (std::isfinite(state.lower)) return std::min(state.lower + state.scale, state.upper);
  return std::isfinite(state.upper) ? state.upper - state.scale : 0.0;
}

ReconstructedStates reconstruct_states(const Model& model, const Signals& signals) {
  const auto& spec = model.system->spec();
  const Eigen::Index samples = signals.samples();
  const double h = usual_step(signals.t);
  ReconstructedStates out;
  out.x = RowMatrix::Zero(samples, model.states());
  out.dx = RowMatrix::Zero(samples, model.states());
  out.ok.assign(signals.samples(), true);
  out.shown.assign(model.states(), false);
  for (std::size_t o = 0; o < spec.outputs.size(); ++o) {
    if (spec.outputs[o].observes >= 0 && o < signals.measured.size())
      add_series(spec.states, spec.outputs[o].observes, {signals.t, signals.measured[o].values, h}, out);
  }
  if (!spec.readable_states.empty() && signals.measured.size() == spec.outputs.size()) {
    const std::vector<std::vector<double>> values = read_all(model, signals);
    for (std::size_t r = 0; r < values.size(); ++r) add_series(spec.states, spec.readable_states[r], {signals.t, values[r], h}, out);
  }
  const SolvedStates solved = solve_outputs(model, signals, out.shown);
  for (std::size_t s = 0; s < solved.states.size(); ++s) add_series(spec.states, solved.states[s], {signals.t, solved.values[s], h}, out);
  for (std::size_t j = 0; j < model.state_specs.size(); ++j) {
    if (!out.shown[j]) out.x.col(j).setConstant(start_of(model.state_specs[j]));
  }
  add_own_states(model, signals, out);
  return out;
}

void add_own_states(const Model& model, const Signals& signals, ReconstructedStates& states) {
  if (model.own_states.empty() || states.x.rows() == 0) return;
  states.x.rightCols(static_cast<Eigen::Index>(model.own_states.size())) = own_states_along(model, signals, states).z;
}

void set_own_states_at_rest(const Model& model, const InputsAt& u, double t, Eigen::Ref<Eigen::VectorXd> at) {
  constexpr double determined = 1e-9;  // reciprocal condition of a block
  const Eigen::Index system = model.system_states();
  for (std::size_t z = 0; z < model.own_states.size(); ++z) at[system + static_cast<Eigen::Index>(z)] = model.own_states[z].initial;
  if (model.own_states.empty()) return;
  Evaluator evaluator(model);
  Slots slots;
  std::vector<double> dx(model.states()), D(model.states() * kRowStride);
  evaluator.linearise_rates({at.data(), u, t}, slots, dx.data(), D.data());
  for (const BoundEffect& effect : model.effects) {
    const Eigen::Index first = system + effect.first_state, size = effect.effect->spec().states.size();
    if (size == 0) continue;
    const Eigen::Map<const RowMatrix, 0, Eigen::OuterStride<>> rows(D.data(), model.states(), model.states(),
                                                                    Eigen::OuterStride<>(kRowStride));
    const Eigen::FullPivLU<Eigen::MatrixXd> block(Eigen::MatrixXd(rows.block(first, first, size, size)));
    const Eigen::VectorXd rest = at.segment(first, size) - block.solve(Eigen::Map<const Eigen::VectorXd>(dx.data() + first, size));
    if (block.rcond() > determined && rest.allFinite()) at.segment(first, size) = rest;
  }
}

double motion_frequency(const Model& model, const ReconstructedStates& states) {
  double fastest = 0.0;
  const auto& spec = model.system->spec();
  for (std::size_t j = 0; j < spec.states.size(); ++j) {
    const int level = spec.states[j].rate_of;
    if (level < 0 || !states.shown[j]) continue;
    double n = 0.0, sum = 0.0, squares = 0.0, rates = 0.0;
    for (Eigen::Index i = 0; i < states.x.rows(); ++i) {
      if (!states.ok[i]) continue;
      n += 1.0;
      sum += states.x(i, level);
      squares += states.x(i, level) * states.x(i, level);
      rates += states.x(i, j) * states.x(i, j);
    }
    const double variance = n > 2.0 ? squares / n - sum * sum / (n * n) : 0.0;
    if (variance > 0.0) fastest = std::max(fastest, std::sqrt(rates / n / variance));
  }
  return fastest;
}

double measurement_noise(const std::vector<double>& values) {
  static constexpr std::array<double, 6> weights = {-1.0, 5.0, -10.0, 10.0, -5.0, 1.0};
  constexpr double gain_squared = 252.0;  // sum of squares of the weights
  std::vector<double> differences;
  for (std::size_t i = 0; i + weights.size() <= values.size(); ++i) {
    double d = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k) d += weights[k] * values[i + k];
    if (std::isfinite(d)) differences.push_back(d);
  }
  if (differences.size() < 10) return std::numeric_limits<double>::quiet_NaN();
  return mad_sigma(differences) / std::sqrt(gain_squared);
}

}  // namespace misfit
