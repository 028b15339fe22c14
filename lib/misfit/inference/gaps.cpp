#include "misfit/inference/gaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "misfit/core/text.h"
#include "misfit/inference/states.h"
#include "misfit/math/statistics.h"
#include "misfit/sim/step.h"
#include "misfit/sim/trajectory.h"

namespace misfit {
namespace {

const char* const part = "_part_";
constexpr double min_gap_steps = 10.0, min_gap_radians = 50.0;
constexpr double min_unknown_input = 3.0;  // times the step that all but 2 % of the steps do not exceed
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double least_input_change = 0.1;  // of its standard deviation
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
  return {values.begin() + first, values.begin() + last};
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

/// RMS change of an input from one sample to the first that comes `later` or more after it, over its standard deviation; 0 of a constant.
double change_within(const std::vector<double>& t, const std::vector<double>& input, double later) {
  const MeanAndSigma level = mean_and_sigma(input);
  if (level.constant()) return 0.0;
  double squares = 0.0, pairs = 0.0;
  for (std::size_t i = 0, j = 0; i < t.size(); ++i) {
    while (j < t.size() && t[j] - t[i] < later) ++j;
    if (j == t.size()) break;
    squares += std::pow(input[j] - input[i], 2);
    pairs += 1.0;
  }
  return pairs > 0.0 ? std::sqrt(squares / pairs) / level.sigma : 0.0;
}

/// An input of the model changes within a time as long as this gap, so that nobody knows what it was there.
bool an_input_is_unknown(const Signals& signals, double gap) {
  return std::any_of(signals.inputs.begin(), signals.inputs.end(), [&](const Signal& input) {
    return input.values.size() == signals.samples() && change_within(signals.t, input.values, gap) > least_input_change;
  });
}

/// [s] All but 2 % of the steps are no longer.
double long_step(const std::vector<double>& t) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < t.size(); ++i) steps.push_back(t[i] - t[i - 1]);
  constexpr double usual_share = 0.98;
  const auto place = steps.begin() + static_cast<std::ptrdiff_t>(usual_share * static_cast<double>(steps.size() - 1));
  std::nth_element(steps.begin(), place, steps.end());
  return *place;
}

/// Why a recording is cut at a sample.
enum class Cut { none, state_is_lost, input_is_unknown };

struct Piece {
  std::size_t first = 0;
  Cut cut = Cut::none;  ///< before it
};

/// First sample of every piece.
std::vector<Piece> pieces_of(const Model& model, const Signals& signals) {
  std::vector<Piece> out{{}};
  if (signals.samples() < 2) return out;
  const double usual = usual_step(signals.t), unknown_from = min_unknown_input * std::max(usual, long_step(signals.t));
  std::optional<double> fastest, changes_within;
  for (std::size_t i = 1; i < signals.samples(); ++i) {
    const double gap = signals.t[i] - signals.t[i - 1];
    if (gap > unknown_from && (gap >= changes_within.value_or(infinity) || an_input_is_unknown(signals, gap))) {
      changes_within = std::min(gap, changes_within.value_or(infinity));
      out.push_back({i, Cut::input_is_unknown});
    } else if (gap > min_gap_steps * usual) {
      if (!fastest) {
        const ReconstructedStates states = reconstruct_states(model, signals);
        fastest = std::max(rate_of_model(model, signals, states), rate_of_data(model, signals, states));
      }
      if (*fastest * gap > min_gap_radians) out.push_back({i, Cut::state_is_lost});
    }
  }
  return out;
}

std::string note_of(const Signals& whole, const std::vector<Piece>& pieces, Cut why) {
  double longest = 0.0;
  std::size_t gaps = 0;
  for (const Piece& piece : pieces) {
    if (piece.cut != why) continue;
    ++gaps;
    longest = std::max(longest, whole.t[piece.first] - whole.t[piece.first - 1]);
  }
  if (gaps == 0) return "";
  const char* const reason = why == Cut::state_is_lost ? "too long for the model to be run across"
                                                       : "in which inputs of the model are unknown and may have changed";
  return fmt::format("cut at {} in time of up to {} s, {}: each part has initial states of its own", counted(gaps, "gap", "gaps"),
                     format_value(longest), reason);
}

}  // namespace

std::vector<Signals> split_at_gaps(const Model& model, Signals signals) {
  const std::vector<Piece> pieces = pieces_of(model, signals);
  std::vector<Signals> out;
  std::size_t left_out = 0;
  for (std::size_t k = 0; k < pieces.size() && pieces.size() > 1; ++k) {
    const std::size_t first = pieces[k].first, end = k + 1 < pieces.size() ? pieces[k + 1].first : signals.samples();
    if (end - first < fewest_samples) {
      left_out += end - first;
      continue;
    }
    out.push_back(piece_of(signals, first, end));
    out.back().after_gap = first > 0;
    out.back().name += part + std::to_string(out.size());
  }
  if (out.empty()) return {std::move(signals)};
  auto& notes = out.front().notes = signals.notes;
  for (const Cut why : {Cut::state_is_lost, Cut::input_is_unknown}) {
    if (std::string note = note_of(signals, pieces, why); !note.empty()) notes.push_back(std::move(note));
  }
  if (left_out > 0)
    notes.back() +=
        "; " + counted(left_out, "sample in a part of fewer than 5 is not used", "samples in parts of fewer than 5 are not used");
  return out;
}

bool is_part_of(const Signals& signals, const std::string& experiment) {
  return signals.name == experiment || signals.name.starts_with(experiment + part);
}

}  // namespace misfit
