#include "misfit/discover/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "misfit/core/display.h"
#include "misfit/core/lists.h"
#include "misfit/core/text.h"
#include "misfit/discover/candidate_model.h"
#include "misfit/discover/operating_range.h"
#include "misfit/inference/standard_error.h"
#include "misfit/inference/states.h"
#include "misfit/math/decompositions.h"
#include "misfit/model/evaluator.h"
#include "misfit/model/memory.h"
#include "misfit/model/whole_steps.h"

namespace misfit {
namespace {

bool is_sensor(const Discovery& discovery, const std::string& effect) {
  return std::any_of(discovery.candidates.begin(), discovery.candidates.end(),
                     [&](const Candidate& c) { return effect_at(c.effect, c.roles) == effect && c.family == CandidateFamily::sensor; });
}

void suggest_experiment(const Candidate& best, bool camera, Discovery& discovery) {
  if (best.group.empty()) return;
  const bool sensor = std::any_of(best.group.begin(), best.group.end(), [&](const std::string& e) { return is_sensor(discovery, e); });
  std::string sentence = "these data cannot distinguish " + join_words(best.group) + ": ";
  if (camera && sensor) {
    sentence += "a calibration sweep that measures roll, image centre and scale with both image coordinates would";
  } else if (camera) {
    sentence += "a recording at another dynamic pressure or another release would";
  } else {
    sentence += sensor ? "a calibration of the sensor, or a recording of another motion, would"
                       : "a recording of another motion (another start, another input) would";
  }
  discovery.sentences.push_back(sentence);
}

/// Why the largest drop is not the one accepted.
void note_larger_drops(const Candidate& best, Discovery& discovery) {
  for (const Candidate& other : discovery.candidates) {
    if (!other.actual_drop || !best.actual_drop || !(*other.actual_drop > *best.actual_drop)) continue;
    discovery.sentences.push_back(effect_at(other.effect, other.roles) + " has a larger drop (" + format_value(*other.actual_drop) +
                                  ") but is not accepted: " + other.why);
  }
}

/// What the flight gives evidence of besides the camera: accepted, of unknown form, or significant without being either; empty: nothing.
std::string physics_evidence(const Discovery& discovery, double p_accept) {
  const auto physical = [](const Candidate& c) { return c.family != CandidateFamily::sensor; };
  for (const Candidate& c : discovery.candidates) {
    if (c.accepted && physical(c)) return effect_at(c.effect, c.roles);
  }
  if (!discovery.unexplained_port.empty()) return unexplained_place(discovery) + " that depends on " + discovery.unexplained_quantity;
  const Candidate* best = nullptr;
  for (const Candidate& c : discovery.candidates) {
    if (physical(c) && c.p_value < p_accept && (best == nullptr || c.p_value < best->p_value)) best = &c;
  }
  return best == nullptr ? "" : effect_at(best->effect, best->roles) + " (family-wise " + p_equals(best->p_value) + ")";
}

/// Measurements of a channel that enter a fit.
std::vector<double> values_in_fit(const Signals& s, int channel) {
  std::vector<double> out;
  for (std::size_t i = s.exclude; i < s.samples(); ++i) {
    const double y = s.measured[channel].values[i];
    if (!s.held_out(i) && std::isfinite(y)) out.push_back(y);
  }
  return out;
}

/// From the nearest of offset + k step, the offset being the circular mean of the values (Mardia & Jupp, Directional Statistics (2000),
/// section 2.2). Values spread evenly over a step have step/sqrt(12).
double rms_from_multiples(const std::vector<double>& values, double step) {
  double cosines = 0.0, sines = 0.0, squares = 0.0;
  for (const double y : values) {
    cosines += std::cos(2.0 * std::numbers::pi * y / step);
    sines += std::sin(2.0 * std::numbers::pi * y / step);
  }
  const double offset = step * std::atan2(sines, cosines) / (2.0 * std::numbers::pi);
  for (const double y : values) squares += std::pow(std::remainder(y - offset, step), 2);
  return values.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(values.size()));
}

/// "tau = 0.16 ± 0.11 s" of a parameter that is smaller than two of its sigmas; nullopt: it is larger, or its sigma is not known.
std::optional<std::string> undetermined(const Model& model, const Eigen::MatrixXd& covariance, int parameter) {
  constexpr double least = 2.0;  // sigmas
  const std::optional<double> sigma = standard_error_of(model, covariance, parameter);
  const Parameter& p = model.parameters[parameter];
  if (!sigma || !(std::abs(p.value) < least * *sigma)) return std::nullopt;
  return p.name + " = " + in_display_unit(p.value, p.unit, *sigma);
}

/// The covariance of the free parameters, that of the last effect's own given all others; of the others as it is.
Eigen::MatrixXd given_the_rest(const Model& model, const Eigen::MatrixXd& covariance) {
  const std::vector<int> free = model.free_parameters();
  std::vector<Eigen::Index> own, rest;
  for (Eigen::Index c = 0; c < covariance.rows(); ++c) {
    const auto& coefficients = model.effects.back().coefficients;
    const bool is_own =
        std::any_of(coefficients.begin(), coefficients.end(), [&](const BoundCoefficient& b) { return b.parameter == free[c]; });
    (is_own ? own : rest).push_back(c);
  }
  Eigen::MatrixXd out = covariance;
  if (own.empty() || rest.empty()) return out;
  const Eigen::VectorXd sigma = covariance.diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt();
  const Eigen::MatrixXd correlation = sigma.cwiseInverse().asDiagonal() * covariance * sigma.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd between = correlation(own, rest);
  const Eigen::MatrixXd left =
      correlation(own, own) - between * symmetric_solve(correlation(rest, rest), Eigen::MatrixXd(between.transpose()));
  out(own, own) = sigma(own).asDiagonal() * left * sigma(own).asDiagonal();
  return out;
}

void say_unexplained(const Unexplained& unexplained, const Candidate& best, Discovery& out) {
  out.unexplained_port = unexplained.port;
  out.unexplained_quantity = unexplained.quantity;
  out.unexplained_error = unexplained.kind == PortKind::sensor;
  out.unexplained_parameter = unexplained.kind == PortKind::quantity;
  out.unexplained_effects = unexplained.effects;
  out.unexplained_alike = unexplained.alike;
  out.outcome = SearchOutcome::unknown_form;
  out.verdict = "Something is missing that depends on " + unexplained.quantity + " (" + unexplained_place(out) + ", " +
                p_equals(unexplained.p_value) + "), and no effect of the library explains it.";
  if (!out.unexplained_alike.empty()) out.sentences.push_back("these data cannot distinguish it from " + join_words(out.unexplained_alike));
  if (best.actual_drop)
    out.sentences.push_back("the best candidate of the library is " + effect_at(best.effect, best.roles) + " (drop " +
                            format_value(*best.actual_drop) + "): " + best.why);
}

void say_none_missing(double p_accept, Discovery& out) {
  double least = 1.0;
  std::string nearest;
  for (const auto& c : out.candidates) {
    if (c.p_value < least) {
      least = c.p_value;
      nearest = effect_at(c.effect, c.roles);
    }
  }
  const std::size_t tested = effects_tested(out) + curves_tested(out);
  const std::string closest = nearest.empty() ? "" : "; the smallest p is " + format_probability(least) + " (" + nearest + ")";
  out.outcome = SearchOutcome::none_missing;
  out.verdict = "No missing effect detected: " +
                (tested == 1 ? "the one candidate does not have both" : "none of " + tested_in_words(out) + " has both") +
                " a family-wise p below " + format_value(p_accept) + " and a held-out gain above ½ per parameter" + closest + ".";
}

constexpr double share_of_step = 0.05;  ///< that measurements in whole steps may be off by (RMS)

}  // namespace

std::optional<Unexplained> with_curves_alike(std::optional<Unexplained> unexplained, const std::vector<UnknownCurve>& all,
                                             const ScoreWork& work, double p_accept) {
  if (!unexplained || !unexplained->curve) return unexplained;
  for (const UnknownCurve& curve : curves_alike(*unexplained->curve, all, work, p_accept)) unexplained->alike.push_back(curve.in_words());
  return unexplained;
}

void write_verdict(Discovery& out, const std::optional<Unexplained>& unexplained, double p_accept, bool camera) {
  if (out.candidates.empty()) {
    out.outcome = SearchOutcome::none_suits;
    out.verdict = "No effect of the library suits this system: none was tested.";
    return;
  }
  const Candidate& best = out.candidates.front();
  if (best.accepted) {
    out.outcome = SearchOutcome::accepted;
    out.verdict = "Missing: " + effect_at(best.effect, best.roles) + " (drop " +
                  format_value(best.actual_drop.value_or(best.predicted_drop)) + ", family-wise " + p_equals(best.p_value) +
                  "): " + parameters_in_words(best) + (best.also ? "; " + *best.also : "") + ".";
    suggest_experiment(best, camera, out);
    note_larger_drops(best, out);
    return;
  }
  if (unexplained) {
    say_unexplained(*unexplained, best, out);
    return;
  }
  if (best.actual_drop && best.p_value < p_accept) {
    out.outcome = SearchOutcome::best_rejected;
    out.verdict = (shows_that_something_is_missing(best) ? "Something is missing, and no effect of the library is accepted; "
                                                         : "No effect accepted; ") +
                  best_rejected(best) + ".";
    return;
  }
  say_none_missing(p_accept, out);
}

std::optional<std::string> ends_at_bound(const Model& model, const std::vector<int>& strengths) {
  constexpr double at_bound_in_scales = 1e-3;
  for (const int index : strengths) {
    const Parameter& p = model.parameters[index];
    if (!p.free) continue;
    for (const double bound : {p.lower, p.upper}) {
      if (bound == 0.0 || !std::isfinite(bound) || std::abs(p.value - bound) > at_bound_in_scales * p.scale) continue;
      return "its strength " + p.name + " ends at its bound " + in_display_unit(bound, p.unit);
    }
  }
  return std::nullopt;
}

std::optional<std::string> undetermined_strengths(const Model& model, const Eigen::MatrixXd& covariance,
                                                  const std::vector<int>& strengths) {
  const bool remembers = has_memory(model.effects.back().effect->spec());
  const Eigen::MatrixXd own = remembers || covariance.size() == 0 ? covariance : given_the_rest(model, covariance);
  std::string values;
  for (const int strength : strengths) {
    const auto value = undetermined(model, own, strength);
    if (!value) return std::nullopt;
    values += (values.empty() ? "" : ", ") + *value;
  }
  if (values.empty()) return std::nullopt;
  return "its strength is not determined: " + values;
}

std::optional<std::string> undetermined_time(const Model& model, const Eigen::MatrixXd& covariance) {
  const BoundEffect& effect = model.effects.back();
  if (!has_linear_memory(*effect.effect) && !reads_the_past(effect.effect->spec())) return std::nullopt;
  for (const auto& coefficient : effect.coefficients) {
    if (coefficient.parameter < 0 || model.parameters[coefficient.parameter].unit != "s") continue;
    if (const auto value = undetermined(model, covariance, coefficient.parameter)) return "its time is not determined: " + *value;
  }
  return std::nullopt;
}

std::optional<std::string> edge_not_visited(const FilterEstimate& estimate) {
  constexpr double margin = 0.1;  // of the visited range
  const OperatingRange visited(estimate);
  const BoundEffect& effect = estimate.model.effects.back();
  for (std::size_t c = 0; c < effect.coefficients.size(); ++c) {
    if (effect.coefficients[c].parameter < 0) continue;
    const auto range = visited.range_of_edge(effect, c);
    if (!range) continue;
    const Parameter& p = estimate.model.parameters[effect.coefficients[c].parameter];
    const double beyond = margin * (range->high - range->low);
    if (p.value >= range->low - beyond && p.value <= range->high + beyond) continue;
    return "its " + p.name + " = " + in_display_unit(p.value, p.unit) + " is outside of what was visited, " +
           in_display_unit(range->low, p.unit) + " to " + in_display_unit(range->high, p.unit) + ": there it is no edge";
  }
  return std::nullopt;
}

std::optional<std::string> recurs_nowhere(const FilterEstimate& estimate) {
  constexpr double least = 1.5;  // spacings
  const OperatingRange visited(estimate);
  const BoundEffect& effect = estimate.model.effects.back();
  for (std::size_t c = 0; c < effect.coefficients.size(); ++c) {
    if (effect.coefficients[c].parameter < 0) continue;
    const auto range = visited.range_of_wave(effect, c);
    if (!range) continue;
    const Parameter& p = estimate.model.parameters[effect.coefficients[c].parameter];
    const double way = range->high - range->low;
    if (way >= least * p.value) continue;
    return "its " + p.name + " = " + in_display_unit(p.value, p.unit) + " is more than two thirds of what was visited, " +
           in_display_unit(way, p.unit) + ", along which it does not recur: there it is one of many curves";
  }
  return std::nullopt;
}

std::optional<std::string> hardly_reached(const FilterEstimate& estimate) {
  constexpr double least = 0.02, at_the_limit = 0.99;
  const BoundEffect& effect = estimate.model.effects.back();
  const EffectSpec& spec = effect.effect->spec();
  const auto limit =
      std::find_if(spec.coefficients.begin(), spec.coefficients.end(), [](const CoefficientSpec& c) { return is_of_a_rate(c.scan); });
  if (limit == spec.coefficients.end() || spec.states.empty()) return std::nullopt;
  const Parameter& p = estimate.model.parameters[effect.coefficients[limit - spec.coefficients.begin()].parameter];
  Evaluator evaluator(estimate.forced.model);
  std::vector<double> rates(evaluator.states());
  const int own = estimate.model.system_states() + effect.first_state;
  double reached = 0.0, samples = 0.0;
  for (std::size_t e = 0; e < estimate.traces.size(); ++e) {
    const FilterTrace& trace = estimate.traces[e];
    const FilterData& data = estimate.data[e];
    for (std::size_t k = data.first; k < trace.samples; ++k) {
      evaluator.rates(trace.filtered(k).data(), data.inputs.at(k), data.signals->t[k], rates.data());
      samples += 1.0;
      if (std::abs(rates[own]) >= at_the_limit * p.value) reached += 1.0;
    }
  }
  if (!(reached < least * samples)) return std::nullopt;
  return "its " + p.name + " = " + in_display_unit(p.value, p.unit) + " is reached in " + format_value(100.0 * reached / samples, 0.1) +
         " % of the samples alone";
}

std::optional<std::string> off_whole_steps(const Model& model, const std::vector<Signals>& experiments) {
  const BoundEffect& effect = model.effects.back();
  const int parameter = step_of_measurements(effect);
  if (parameter < 0) return std::nullopt;
  const Parameter& p = model.parameters[parameter];
  const double step = std::abs(p.value);
  for (const Signals& s : experiments) {
    const std::vector<double> values = values_in_fit(s, effect.ports.front());
    constexpr double noises = 2.0;
    const double noise = measurement_noise(values), off = rms_from_multiples(values, step);
    if (!(off > share_of_step * step + (std::isfinite(noise) ? noises * noise : 0.0))) continue;
    return "its " + p.name + " = " + in_display_unit(p.value, p.unit) + ", but the measurements are " + in_display_unit(off, p.unit) +
           " (RMS) from multiples of it";
  }
  return std::nullopt;
}

std::optional<std::string> on_whole_steps(const Model& model, const std::vector<Signals>& experiments) {
  const int parameter = step_of_measurements(model.effects.back());
  if (parameter < 0) return std::nullopt;
  const Parameter& p = model.parameters[parameter];
  const double step = std::abs(p.value);
  const int output = model.effects.back().ports.front();
  const auto off = [&](const Signals& s) { return rms_from_multiples(values_in_fit(s, output), step) > share_of_step * step; };
  if (std::any_of(experiments.begin(), experiments.end(), off)) return std::nullopt;
  return "the measurements are in whole steps of " + in_display_unit(step, p.unit) + " all the same, noise of " +
         in_display_unit(step / std::sqrt(12.0), p.unit) + " to a filter";
}

bool are_coarse_steps(const Model& model, const FilterEstimate& without) {
  constexpr double most_of = 0.5;
  const int parameter = step_of_measurements(model.effects.back());
  if (parameter < 0) return false;
  const std::size_t output = model.effects.back().ports.front(), outputs = without.model.outputs();
  double sum = 0.0, weights = 0.0;
  for (std::size_t e = 0; e < without.data.size(); ++e) {
    const FilterTrace& trace = without.traces[e];
    for (std::size_t at = output; at < without.data[e].use.size(); at += outputs) {
      if (without.data[e].use[at] != SampleRole::counted) continue;
      sum += std::pow(trace.departure(at), 2) / trace.variance(at);
      weights += 1.0 / trace.variance(at);
    }
  }
  return weights > 0.0 && std::abs(model.parameters[parameter].value) / std::sqrt(12.0) > most_of * std::sqrt(sum / weights);
}

void add_camera_remarks(const Calibration* calibration, double p_accept, Discovery& out) {
  if (calibration == nullptr) return;
  std::vector<std::string> wanted;
  for (const auto& test : calibration->tests) {
    constexpr double p_of_wanted_parameter = 1e-3;
    if (!test.selected && test.p_value < p_of_wanted_parameter) wanted.push_back(test.name);
  }
  if (wanted.empty()) return;
  out.sweep_asks = wanted;
  for (auto& c : out.candidates) {
    if (wanted.size() > 1 && std::find(wanted.begin(), wanted.end(), c.effect) != wanted.end()) c.group = wanted;
  }
  const std::string remedy = "add " + join_words(wanted) + " to [camera] free, then misfit run";
  const std::string disagreement =
      "the calibration sweep shows significant " + join_words(wanted) + ", which the camera of this study does not have";
  const std::string flight = physics_evidence(out, p_accept);
  for (auto& c : out.candidates) {
    if (!c.accepted) continue;
    c.accepted = false;
    c.why = "the calibration sweep shows significant " + join_words(wanted) + ": " + remedy + " (" + c.why + ")";
  }
  out.outcome = flight.empty() ? SearchOutcome::camera_incomplete : SearchOutcome::camera_against_flight;
  if (flight.empty()) {
    out.verdict = "The camera model is incomplete: " + disagreement + "; " + remedy + ".";
  } else {
    out.verdict = "Sweep and flight disagree: " + disagreement + ", and the flight gives evidence of " + flight + "; first " + remedy +
                  ", since the error of a wrong camera model can be described by a physical effect.";
  }
}

std::optional<std::string> no_longer_determined(const FilterEstimate& with, const FilterEstimate& without) {
  constexpr double known = 0.05, unknown = 0.5;  // of the value without the effect
  constexpr double known_anew = 0.2;             // of the value with it
  for (const int i : without.model.free_parameters()) {
    const Parameter& before = without.model.parameters[i];
    const Parameter& after = with.model.parameters[i];
    const auto sigma = standard_error_of(without.model, without.covariance, i), wider = standard_error_of(with.model, with.covariance, i);
    if (before.curve >= 0 || !sigma || !wider) continue;
    const bool was_known = *sigma < known * std::abs(before.value), is_known = *wider < known_anew * std::abs(after.value);
    if (!was_known || is_known || !(*wider > unknown * std::abs(before.value))) continue;
    return "with it in the model " + after.name + " is no longer determined: " + in_display_unit(after.value, after.unit, *wider) +
           ", without it " + in_display_unit(before.value, before.unit, *sigma) + ": these data cannot tell the two apart";
  }
  return std::nullopt;
}

}  // namespace misfit
