#include "misfit/inference/states.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "misfit/core/lists.h"
#include "misfit/core/watch.h"
#include "misfit/inference/own_clocks.h"
#include "misfit/inference/own_samples.h"
#include "misfit/inference/own_states.h"
#include "misfit/inference/solved_states.h"
#include "misfit/math/decompositions.h"
#include "misfit/math/statistics.h"
#include "misfit/model/evaluator.h"

namespace misfit {
namespace {

/// Of the channel that has fewest.
std::size_t fewest_measurements(const Signals& signals) {
  std::size_t out = signals.samples();
  for (const Signal& channel : signals.measured) out = std::min(out, count_finite(channel.values));
  return out;
}

/// What shows the states: of several series of one state that of most measurements, the first of these.
class ShownStates {
 public:
  /// `own_clocks`: of the sensors.
  ShownStates(const std::vector<StateSpec>& states, const std::vector<double>& t, bool own_clocks)
      : states_(states), t_(t), own_clocks_(own_clocks), series_(states.size()), measured_(states.size(), 0) {}

  void add(int state, const std::vector<double>& values, std::size_t measured) {
    if (series_[state] && measured <= measured_[state]) return;
    series_[state] = values;
    measured_[state] = measured;
  }

  /// Measured ones, and the rates of these that are not measured themselves.
  [[nodiscard]] std::vector<bool> shown(std::size_t states) const {
    std::vector<bool> out(states, false);
    for (std::size_t j = 0; j < states_.size(); ++j) out[j] = series_[j] || (states_[j].rate_of >= 0 && series_[states_[j].rate_of]);
    return out;
  }

  void fill(ReconstructedStates& out) const {
    out.shown = shown(out.shown.size());
    for (std::size_t j = 0; j < states_.size(); ++j) {
      if (series_[j]) fill_from(static_cast<int>(j), *series_[j], out);
    }
  }

 private:
  void fill_from(int state, const std::vector<double>& values, ReconstructedStates& out) const {
    int rate = -1;
    for (std::size_t j = 0; j < states_.size(); ++j) {
      if (states_[j].rate_of == state && !series_[j]) rate = static_cast<int>(j);
    }
    const Series series{t_, values, usual_step(t_)};
    const std::optional<OwnSamples> own = own_clocks_ ? std::optional(OwnSamples(t_, values)) : std::nullopt;
    for (Eigen::Index i = 0; i < out.x.rows(); ++i) {
      const LocalFit fit = own ? own->at(t_[i]) : local_quadratic(series, i);
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

  const std::vector<StateSpec>& states_;
  const std::vector<double>& t_;
  bool own_clocks_;
  std::vector<std::optional<std::vector<double>>> series_;
  std::vector<std::size_t> measured_;
};

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

/// At these rows, NaN at the others.
std::vector<double> scattered(const std::vector<double>& values, const std::vector<std::size_t>& rows, std::size_t size) {
  std::vector<double> out(size, std::nan(""));
  for (std::size_t i = 0; i < rows.size(); ++i) out[rows[i]] = values[i];
  return out;
}

/// See measurement_noise(); NaN where fewer than ten differences are known.
double noise_of_neighbours(const std::vector<double>& values) {
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

}  // namespace

double start_of(const StateSpec& state) {
  if (std::isfinite(state.start)) return state.start;
  if (std::isfinite(state.lower)) return std::min(state.lower + state.scale, state.upper);
  return std::isfinite(state.upper) ? state.upper - state.scale : 0.0;
}

ReconstructedStates reconstruct_states(const Model& model, const Signals& signals) {
  const auto& spec = model.system->spec();
  const Eigen::Index samples = signals.samples();
  ReconstructedStates out;
  out.x = RowMatrix::Zero(samples, model.states());
  out.dx = RowMatrix::Zero(samples, model.states());
  out.ok.assign(signals.samples(), true);
  out.shown.assign(model.states(), false);
  const bool own_clocks = have_own_clocks(signals);
  ShownStates states(spec.states, signals.t, own_clocks);
  for (std::size_t o = 0; o < spec.outputs.size(); ++o) {
    if (spec.outputs[o].observes >= 0 && o < signals.measured.size())
      states.add(spec.outputs[o].observes, signals.measured[o].values, count_finite(signals.measured[o].values));
  }
  const DensestRows dense = own_clocks ? at_densest(signals) : DensestRows{};
  const Signals& together = own_clocks ? dense.signals : signals;
  const auto add = [&](int state, const std::vector<double>& values) {
    states.add(state, own_clocks ? scattered(values, dense.rows, signals.samples()) : values, fewest_measurements(signals));
  };
  if (!spec.readable_states.empty() && signals.measured.size() == spec.outputs.size()) {
    const std::vector<std::vector<double>> values = read_all(model, together);
    for (std::size_t r = 0; r < values.size(); ++r) add(spec.readable_states[r], values[r]);
  }
  const SolvedStates solved = solve_outputs(model, together, states.shown(out.shown.size()));
  for (std::size_t s = 0; s < solved.states.size(); ++s) add(solved.states[s], solved.values[s]);
  states.fill(out);
  for (std::size_t j = 0; j < model.state_specs.size(); ++j) {
    if (!out.shown[j]) out.x.col(j).setConstant(start_of(model.state_specs[j]));
  }
  add_own_states(model, signals, out);
  return out;
}

void add_own_states(const Model& model, const Signals& signals, ReconstructedStates& states) {
  if (model.own_states.empty() || states.x.rows() == 0) return;
  states.x.rightCols(std::ssize(model.own_states)) = own_states_along(model, signals, states).z;
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
    const std::optional<Eigen::MatrixXd> change =
        solve(rows.block(first, first, size, size), Eigen::Map<const Eigen::VectorXd>(dx.data() + first, size), determined);
    if (change && change->allFinite()) at.segment(first, size) -= *change;
  }
}

double motion_frequency(const Model& model, const ReconstructedStates& states) {
  double fastest = 0.0;
  const auto& spec = model.system->spec();
  for (std::size_t j = 0; j < spec.states.size(); ++j) {
    const int level = spec.states[j].rate_of;
    if (level < 0 || !states.shown[j]) continue;
    std::vector<double> levels;
    double rates = 0.0;
    for (Eigen::Index i = 0; i < states.x.rows(); ++i) {
      if (!states.ok[i]) continue;
      levels.push_back(states.x(i, level));
      rates += states.x(i, j) * states.x(i, j);
    }
    const MeanAndSigma spread = mean_and_sigma(levels);
    const auto n = static_cast<double>(levels.size());
    if (n > 2.0 && !spread.constant()) fastest = std::max(fastest, std::sqrt(rates / n) / spread.sigma);
  }
  return fastest;
}

double measurement_noise(const std::vector<double>& values) {
  const double noise = noise_of_neighbours(values);
  if (std::isfinite(noise)) return noise;
  std::vector<double> known = values;  // a sensor with a clock of its own: from its own samples
  std::erase_if(known, [](double value) { return !std::isfinite(value); });
  return noise_of_neighbours(known);
}

}  // namespace misfit
