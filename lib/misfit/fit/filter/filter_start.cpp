#include "misfit/fit/filter/filter_start.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "misfit/core/error.h"
#include "misfit/core/units.h"
#include "misfit/inference/own_clocks.h"
#include "misfit/inference/own_samples.h"
#include "misfit/math/statistics.h"
#include "misfit/math/whiteness.h"

namespace misfit {
namespace {

/// RMS of the derivatives of the system's states over a recording.
struct RateSizes {
  Eigen::VectorXd rms;
  std::vector<bool> shown;  ///< by a channel
};

/// Of states that channels show, the derivatives read from these. Of the others those that the model gives at the states read and the
/// recorded inputs, but at least one by which the state moves by its typical size in the length of the recording.
RateSizes rate_sizes(const FilterModel& model, const FilterData& data, const ReconstructedStates& states) {
  Evaluator evaluator(model.model);
  const Eigen::Index system = model.model.system_states();
  const std::vector<double>& t = data.signals->t;
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(system), dx = Eigen::VectorXd::Zero(evaluator.states()), x = data.start;
  double count = 0.0;
  for (Eigen::Index k = 0; k < states.dx.rows(); ++k) {
    if (!states.ok[k]) continue;
    x.head(system) = states.x.row(k).head(system).transpose();
    evaluator.rates(x.data(), data.inputs.at(k), t[k], dx.data());
    for (Eigen::Index i = 0; i < system; ++i) squares[i] += std::pow(states.shown[i] ? states.dx(k, i) : dx[i], 2);
    count += 1.0;
  }
  RateSizes out{(squares / std::max(count, 1.0)).cwiseSqrt(), states.shown};
  for (Eigen::Index i = 0; i < system; ++i) {
    const double slowest = model.model.state_specs[i].scale / std::max(t.back() - t[data.first], usual_step(t));
    if (!states.shown[i]) out.rms[i] = std::isfinite(out.rms[i]) ? std::max(out.rms[i], slowest) : slowest;
  }
  return out;
}

/// |dx'/dF| of each system state and force at the first sample; where that is next to nothing beside the largest of a few samples (a gain
/// may depend on the state and on inputs), the largest.
Eigen::MatrixXd usual_gains(const FilterModel& model, const FilterData& data) {
  constexpr std::size_t samples = 20;
  constexpr double next_to_nothing = 0.01;
  Evaluator evaluator(model.model);
  const int n = evaluator.states(), system = model.model.system_states();
  std::vector<double> dx(n), D(n * kRowStride);
  Eigen::MatrixXd first = Eigen::MatrixXd::Zero(system, std::ssize(model.force_states)), largest = first;
  Eigen::VectorXd x = data.start;
  const std::size_t last = data.signals->samples(), stride = std::max<std::size_t>((last - data.first) / samples, 1);
  for (std::size_t k = data.first; k < last; k += stride) {
    const Eigen::Index row = k;
    if (k > data.first && !(data.read && data.read->ok[k])) continue;
    if (k > data.first) x.head(system) = data.read->x.row(row).head(system).transpose();
    Slots slots;
    evaluator.linearise_rates({x.data(), data.inputs.at(k), data.signals->t[k]}, slots, dx.data(), D.data());
    for (Eigen::Index f = 0; f < first.cols(); ++f) {
      for (int i = 0; i < system; ++i) {
        const double gain = std::abs(D[i * kRowStride + model.force_states[f]]);
        if (!std::isfinite(gain)) continue;
        if (k == data.first) first(i, f) = gain;
        largest(i, f) = std::max(largest(i, f), gain);
      }
    }
  }
  return (first.array() > next_to_nothing * largest.array()).select(first, largest);
}

/// Size of a random force that alone would cause the accelerations: the largest RMS of x' over |dx'/dF|, over the states on which a force
/// of the group acts; of those that channels show, if there are any. 1 where it acts on none.
double force_size(const FilterModel& model, int group, const FilterData& data, const RateSizes& rates) {
  const Eigen::MatrixXd gains = usual_gains(model, data);
  double shown = 0.0, hidden = 0.0;
  for (std::size_t force = 0; force < model.force_states.size(); ++force) {
    if (model.force_group[force] != group) continue;
    for (int i = 0; i < model.model.system_states(); ++i) {  // not the own states of effects
      const double gain = gains(i, static_cast<Eigen::Index>(force));
      if (model.kind[i] != 1 || !(gain > 0.0)) continue;
      double& size = rates.shown[i] ? shown : hidden;
      size = std::max(size, rates.rms[i] / gain);
    }
  }
  return shown > 0.0 ? shown : hidden > 0.0 ? hidden : 1.0;
}

/// The recording decimated by `count`, each sample the mean of `count` neighbours; a channel is missing where one of its neighbours is.
Signals averaged(const Signals& signals, std::size_t count) {
  Signals out;
  out.name = signals.name;
  for (std::size_t at = 0; at + count <= signals.samples(); at += count) {
    double t = 0.0;
    for (std::size_t k = at; k < at + count; ++k) t += signals.t[k] / static_cast<double>(count);
    out.t.push_back(t);
  }
  const auto average = [&](const std::vector<Signal>& from, std::vector<Signal>& to) {
    for (const Signal& signal : from) {
      to.push_back({signal.name, signal.unit, {}, signal.sigma / std::sqrt(static_cast<double>(count))});
      if (signal.values.empty()) continue;  // an input that the model does not need
      for (std::size_t at = 0; at + count <= signals.samples(); at += count) {
        double sum = 0.0;
        for (std::size_t k = at; k < at + count; ++k) sum += signal.values[k];
        to.back().values.push_back(sum / static_cast<double>(count));
      }
    }
  };
  average(signals.measured, out.measured);
  average(signals.inputs, out.inputs);
  return out;
}

/// A recording with the states read from it and the sizes of their derivatives.
struct SizedRecording {
  double step = 0.0;  ///< [s] usual one between its samples
  ReconstructedStates states;
  RateSizes rates;
};

SizedRecording sized(const FilterModel& model, const FilterData& data) {
  SizedRecording out{usual_step(data.signals->t), reconstruct_states(model.model, *data.signals), {}};
  out.rates = rate_sizes(model, data, out.states);
  return out;
}

/// FilterData for `signals`, other samples of the same recording, from the sample `first` on.
FilterData with_rows(const FilterModel& model, const FilterData& data, const Signals& signals, std::size_t first) {
  FilterData out;
  out.signals = &signals;
  out.inputs = input_table(signals, model.model);
  out.first = std::min(first, signals.samples() - 1);
  out.start = data.start;
  return out;
}

/// Of the recording decimated by `count`.
SizedRecording sized_means(const FilterModel& model, const FilterData& data, std::size_t count) {
  const Signals signals = averaged(*data.signals, count);
  return sized(model, with_rows(model, data, signals, data.first / count));
}

/// Are the accelerations read from the channels mostly differentiated measurement noise? It is noise if both hold: they are uncorrelated
/// at lags beyond the five samples from which each is read, and decimating by two more than halves them.
bool mostly_noise(const FilterModel& model, const SizedRecording& recording, const SizedRecording& coarser) {
  constexpr double of_motion = 0.5, largest_memory = 0.25;
  constexpr int first_apart = 6, last = 9;  // lags; from 5 on two accelerations have no sample in common
  for (int i = 0; i < model.model.system_states(); ++i) {
    if (model.kind[i] != 1 || !recording.rates.shown[i]) continue;
    if (coarser.rates.rms[i] > of_motion * recording.rates.rms[i]) continue;
    std::vector<double> rates;
    for (Eigen::Index k = 0; k < recording.states.dx.rows(); ++k)
      rates.push_back(recording.states.ok[k] ? recording.states.dx(k, i) : std::nan(""));
    const std::vector<double> rho = autocorrelation(rates, last);
    bool memory = false;
    for (int lag = first_apart; lag <= last; ++lag) memory = memory || !(std::abs(rho[lag]) < largest_memory);
    if (!memory) return true;
  }
  return false;
}

/// The recording, decimated by 2, 4, 8, … as long as its accelerations are mostly noise. This matters where a noisy sensor is sampled much
/// faster than the motion: differentiated noise grows with the square of the sampling rate, so that the usual random force taken from it,
/// and with that the lower bound of its estimate (a thousandth of the usual one), could exceed any force that acts.
SizedRecording sized_by_motion(const FilterModel& model, const FilterData& data) {
  if (have_own_clocks(*data.signals)) {
    const DensestRows dense = at_densest(*data.signals);
    const auto first = std::lower_bound(dense.rows.begin(), dense.rows.end(), data.first);
    return sized_by_motion(model, with_rows(model, data, dense.signals, first - dense.rows.begin()));
  }
  constexpr std::size_t fewest = 100;  // means
  SizedRecording out = sized(model, data);
  for (std::size_t count = 2; data.signals->samples() / count >= fewest; count *= 2) {
    SizedRecording coarser = sized_means(model, data, count);
    if (!mostly_noise(model, out, coarser)) break;
    out = std::move(coarser);
  }
  return out;
}

/// Of readings that a converter or an encoder rounds to whole steps; 0 of others.
double rounding_noise(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  return resolution_of(std::move(values)) / std::sqrt(12.0);
}

}  // namespace

void mark_rounding(const FilterModel& model, const std::vector<FilterData>& data, FilterNoise& usual) {
  for (std::size_t o = 0; o < usual.channels.size(); ++o) {
    ChannelNoise& channel = usual.channels[o];
    const bool takes_intervals = !model.steps.empty() && model.steps[o] > 0.0;
    channel.rounding = channel.given || takes_intervals ? 0.0 : rounding_noise(data.front().signals->measured[o].values);
    channel.white = std::max(channel.white, channel.rounding);
  }
}

void mark_known(const FilterModel& model, FilterNoise& usual) {
  usual.time_is_given = model.model.force_time.has_value();
  for (std::size_t o = 0; o < usual.channels.size(); ++o) usual.channels[o].given = model.model.known_noise[o].fixed;
  if (!model.model.force_strength) return;
  const KnownForce& known = *model.model.force_strength;
  const auto& ports = model.model.system->spec().dynamic_ports;
  const auto acts = [&](int port) { return known.unit.empty() || parse_unit(ports[port].unit).same_dimension(parse_unit(known.unit)); };
  const auto port = std::find_if(model.force_ports.begin(), model.force_ports.end(), acts);
  if (port == model.force_ports.end()) throw RunError("[force] strength: the random force acts on no port in " + known.unit);
  usual.prior = {model.force_group[port - model.force_ports.begin()], known.median, known.sigma / known.median};
}

/// White noise and coloured noise as large, well above the motion (circular frequency `motion`), which the model itself must explain;
/// pack() lets the coloured noise's frequency down to half of this. Where a study names a frequency: there. A sensor with a clock of its
/// own that shows nothing so fast has none.
ChannelNoise usual_channel(const Model& model, const Signals& signals, std::size_t o, double motion) {
  const KnownNoise& known = model.known_noise[o];
  const OutputSpec& output = model.system->spec().outputs[o];
  constexpr double share_of_rate = 0.15, highest_share = 0.3, above_motion = 3.0;
  const std::vector<double>& values = signals.measured[o].values;
  const double step = own_step(signals, o), least = above_motion * motion / (2.0 * std::numbers::pi);
  ChannelNoise out;
  out.white = known.sigma > 0.0 ? known.sigma : measurement_noise(values);
  if (!(out.white > 0.0)) out.white = output.noise > 0.0 ? output.noise : 1.0;
  out.coloured_frequency = std::min(std::max(share_of_rate / step, least), highest_share / step);
  out.no_coloured = out.coloured_frequency < least && have_own_clocks(signals);
  if (known.frequency > 0.0) {
    out.coloured_frequency = known.frequency;
    out.no_coloured = false;
  }
  out.coloured = known.fixed || out.no_coloured ? 1e-3 * out.white : out.white;
  return out;
}

FilterNoise usual_noise(const FilterModel& model, const std::vector<FilterData>& data) {
  constexpr double share_of_motion = 0.3, samples_of_memory = 6.0;
  FilterNoise out;
  const Signals& first = *data.front().signals;
  std::vector<SizedRecording> recordings;
  for (const FilterData& recording : data) recordings.push_back(sized_by_motion(model, recording));
  const double h = step_of_measurements(first);
  constexpr double memory_of_white = 0.3;  // samples: correlated by 4 % at the next
  out.force_time =
      model.model.force_time ? std::max(*model.model.force_time, memory_of_white * h) : samples_of_memory * recordings.front().step;
  const auto usual_force = [&](int group) {  // of the recording that moves most
    double largest = 0.0;
    for (std::size_t e = 0; e < data.size(); ++e) {
      const double of_equal_intensity = std::sqrt(samples_of_memory * recordings[e].step / out.force_time);
      largest = std::max(largest, share_of_motion * force_size(model, group, data[e], recordings[e].rates) * of_equal_intensity);
    }
    return largest;
  };
  out.force = usual_force(0);
  for (int group = 1; group < model.force_groups(); ++group) out.further_forces.push_back(usual_force(group));
  const double motion = motion_frequency(model.model, recordings.front().states);
  for (std::size_t o = 0; o < first.measured.size(); ++o) out.channels.push_back(usual_channel(model.model, first, o, motion));
  mark_known(model, out);
  return out;
}

}  // namespace misfit
