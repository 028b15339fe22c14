#include "misfit/inference/gaps.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/text.h"
#include "misfit/inference/states.h"
#include "misfit/math/statistics.h"
#include "misfit/sim/step.h"
#include "misfit/sim/trajectory.h"

namespace misfit {
namespace {

const char* const part = "_part_";
constexpr double min_gap_steps = 10.0, min_gap_radians = 50.0;
constexpr std::size_t fewest_samples = 5;

/// The model's fastest rate over the samples at which its states are known; 0 if it says nothing.
double rate_of_model(const Model& model, const Signals& signals, const ReconstructedStates& states) {
  Evaluator evaluator(model);
  const InputTable inputs = input_table(signals, model);
  constexpr std::size_t evaluated_samples = 20;
  const std::size_t stride = std::max<std::size_t>(1, signals.samples() / evaluated_samples);
  double fastest = 0.0;
  for (std::size_t i = 0; i < signals.samples(); i += stride) {
    const double rate = evaluator.fastest_rate(states.x.row(i).data(), inputs.at(i), signals.t[i]);
    if (states.ok[i] && std::isfinite(rate)) fastest = std::max(fastest, rate);
  }
  return fastest;
}

/// rms(x')/sd(x) of the states that a channel shows, less what the measurement noise does to slopes of local parabolas.
double rate_of_data(const Model& model, const Signals& signals, const ReconstructedStates& states) {
  const auto& outputs = model.system->spec().outputs;
  const double step = usual_step(signals.t);
  double fastest = 0.0;
  for (std::size_t o = 0; o < outputs.size() && o < signals.measured.size(); ++o) {
    if (outputs[o].observes < 0) continue;
    std::vector<double> levels;
    double slopes = 0.0;
    for (std::size_t i = 0; i < signals.samples(); ++i) {
      if (!states.ok[i]) continue;
      levels.push_back(states.x(i, outputs[o].observes));
      slopes += std::pow(states.dx(i, outputs[o].observes), 2);
    }
    const double noise = measurement_noise(signals.measured[o].values);
    constexpr double slope_variance_factor = 0.1;  // sum of squares of the weights of five even samples
    const double share = std::isfinite(noise) ? slope_variance_factor * noise * noise / (step * step) : 0.0;
    const MeanAndSigma level = mean_and_sigma(levels);
    const auto n = static_cast<double>(levels.size());
    if (n > 2.0 && !level.constant()) fastest = std::max(fastest, std::sqrt(std::max(slopes / n - share, 0.0)) / level.sigma);
  }
  return fastest;
}

std::vector<double> part_of(const std::vector<double>& values, std::size_t first, std::size_t last) {
  if (values.size() < last) return values;  // an input that nobody needs has none
  return {values.begin() + static_cast<std::ptrdiff_t>(first), values.begin() + static_cast<std::ptrdiff_t>(last)};
}

Signals piece_of(const Signals& whole, std::size_t first, std::size_t last) {
  Signals out = whole;
  out.t = part_of(whole.t, first, last);
  for (auto* signals : {&out.measured, &out.inputs}) {
    for (Signal& s : *signals) s.values = part_of(s.values, first, last);
  }
  out.exclude = std::clamp(whole.exclude, first, last) - first;
  out.notes.clear();
  return out;
}

/// First sample of every piece, and the end of the last.
std::vector<std::size_t> cuts_of(const Model& model, const Signals& signals) {
  std::vector<std::size_t> cuts{0};
  const double usual = usual_step(signals.t);
  std::vector<std::size_t> long_steps;
  for (std::size_t i = 1; i < signals.samples(); ++i) {
    if (signals.t[i] - signals.t[i - 1] > min_gap_steps * usual) long_steps.push_back(i);
  }
  if (!long_steps.empty()) {
    const ReconstructedStates states = reconstruct_states(model, signals);
    const double fastest = std::max(rate_of_model(model, signals, states), rate_of_data(model, signals, states));
    for (const std::size_t i : long_steps) {
      if (fastest * (signals.t[i] - signals.t[i - 1]) > min_gap_radians) cuts.push_back(i);
    }
  }
  cuts.push_back(signals.samples());
  return cuts;
}

std::string note_of(const Signals& whole, const std::vector<std::size_t>& cuts, std::size_t left_out) {
  double longest = 0.0;
  for (std::size_t k = 1; k + 1 < cuts.size(); ++k) longest = std::max(longest, whole.t[cuts[k]] - whole.t[cuts[k] - 1]);
  const std::size_t gaps = cuts.size() - 2;
  std::string text = "cut at " + std::to_string(gaps) + (gaps == 1 ? " gap" : " gaps") + " in time of up to " + format_value(longest) +
                     " s, too long for the model to be run across: each part has initial states of its own";
  if (left_out > 0)
    text += "; " + counted(left_out, "sample in a part of fewer than 5 is not used", "samples in parts of fewer than 5 are not used");
  return text;
}

}  // namespace

std::vector<Signals> split_at_gaps(const Model& model, Signals signals) {
  const std::vector<std::size_t> cuts = cuts_of(model, signals);
  std::vector<Signals> out;
  std::size_t left_out = 0;
  for (std::size_t k = 0; k + 1 < cuts.size() && cuts.size() > 2; ++k) {
    if (cuts[k + 1] - cuts[k] < fewest_samples) {
      left_out += cuts[k + 1] - cuts[k];
      continue;
    }
    out.push_back(piece_of(signals, cuts[k], cuts[k + 1]));
    out.back().after_gap = cuts[k] > 0;
    out.back().name += part + std::to_string(out.size());
  }
  if (out.empty()) return {std::move(signals)};
  out.front().notes = signals.notes;
  out.front().notes.push_back(note_of(signals, cuts, left_out));
  return out;
}

bool is_part_of(const Signals& signals, const std::string& experiment) {
  return signals.name == experiment || signals.name.starts_with(experiment + part);
}

}  // namespace misfit
