#include "misfit/discover/refit_forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/core/watch.h"
#include "misfit/discover/candidate_model.h"
#include "misfit/discover/drift.h"
#include "misfit/discover/exchanged_poles.h"
#include "misfit/discover/unknown_curves.h"
#include "misfit/discover/whole_strength.h"
#include "misfit/inference/standard_error.h"
#include "misfit/math/statistics.h"
#include "misfit/model/does_not_suit.h"
#include "misfit/model/memory.h"
#include "misfit/model/whole_steps.h"

namespace misfit {
namespace {

/// A share g of an effect with a linear memory of the time constant tau looks nearly like the whole of it with the time constant g tau.
Model start_of_whole(const Model& part, const std::vector<WholeStrength>& whole) {
  Model start = part;
  const Effect& effect = *part.effects.back().effect;
  const bool scales = has_linear_memory(effect) || reads_the_past(effect.spec());
  for (const WholeStrength& w : whole) {
    Parameter& p = start.parameters[w.parameter];
    const double share = std::abs(p.value / w.value);
    p.value = w.value;
    p.free = false;
    for (const BoundCoefficient& c : part.effects.back().coefficients) {
      if (!scales || c.parameter < 0 || start.parameters[c.parameter].unit != "s") continue;
      Parameter& time = start.parameters[c.parameter];
      time.value = std::clamp(share * time.value, std::max(time.lower, 1e-3 * time.value), time.upper);
    }
  }
  return start;
}

/// With two free shapes an effect follows much that it is not, so long as it may be a part of itself.
bool is_flexible(const FilterEstimate& estimate) {
  const BoundEffect& effect = estimate.model.effects.back();
  const auto free = std::count_if(effect.coefficients.begin(), effect.coefficients.end(), [&](const BoundCoefficient& c) {
    return c.parameter >= 0 && estimate.model.parameters[c.parameter].free &&
           estimate.model.parameters[c.parameter].kind == CoefficientKind::shape;
  });
  return free > 1;
}

/// "late_share = 0.12 ± 0.01, where the whole effect would have 1.00"; empty where the strengths are about whole. A flexible effect that
/// fits worse as a whole is none, nor is one of which the whole explains less than half (`of_whole`: its share of the drop).
std::string part_of_effect(const FilterEstimate& estimate, const std::vector<WholeStrength>& whole, double of_whole) {
  constexpr double most = 0.5;
  constexpr double more = 0.2;  // of the whole: formulas idealise, which takes away rather than adds
  // What is left in steps may have had noise before: of a sawtooth of the prediction that leaves the mean over that noise, a part (its
  // first harmonic is exp(-2 pi^2 sigma^2/step^2) as large). The steps themselves are looked for in the measurements (off_whole_steps()).
  const double less = step_of_measurements(estimate.model.effects.back()) >= 0 ? 0.9 : 0.3;
  for (const WholeStrength& w : whole) {
    const Parameter& p = estimate.model.parameters[w.parameter];
    const double sigma = standard_error_of(estimate.model, estimate.covariance, w.parameter).value_or(0.0);
    const double share = p.value / w.value, of_sigma = 2.0 * sigma / std::abs(w.value);
    const bool about_whole = share >= 1.0 - std::max(less, of_sigma) && share <= 1.0 + std::max(more, of_sigma);
    if (about_whole && of_whole > most && !is_flexible(estimate)) continue;
    return p.name + " = " + in_display_unit(p.value, p.unit, sigma) + ", where the whole effect would have " +
           in_display_unit(w.value, p.unit) + (about_whole ? ", and fits worse" : "");
  }
  return {};
}

/// [log-likelihood] What the whole effect may cost: as much as a free share gains by chance (gain_by_chance), or a hundredth of what it
/// explains, since formulas idealise; a tenth, where it was found to 2 % of the whole, and so is no part.
double allowed_of_whole(const RefitWork& work, const FilterEstimate& part, const std::vector<WholeStrength>& whole) {
  constexpr double about = 0.02, of_gain = 0.01, of_gain_near = 0.1;
  const bool near = std::all_of(whole.begin(), whole.end(), [&](const WholeStrength& w) {
    return std::abs(part.model.parameters[w.parameter].value / w.value - 1.0) < about;
  });
  return std::max(gain_by_chance, (near ? of_gain_near : of_gain) * (part.objective - work.without.objective));
}

/// A start with the whole effect, and what it was assembled from.
struct WholeStart {
  Model model;
  ModelRequest request;
  std::optional<std::map<std::string, std::string>> moved;
};

/// On the input itself where that is possible: on_its_input(). `model`: with the whole effect at its port.
WholeStart whole_start(const RefitWork& work, const Model& model, const ModelRequest& as_requested) {
  WholeStart out{model, as_requested, {}};
  const std::optional<ModelRequest> request = on_its_input(model, as_requested);
  if (!request) return out;
  try {
    Model there = with_the_same_values(assemble(*request, work.registry), out.model);
    const BoundEffect& bound = there.effects.back();
    for (std::size_t c = 0; c < bound.coefficients.size(); ++c) {
      const double of_input = bound.effect->spec().coefficients[c].whole;
      if (of_input != 0.0 && bound.coefficients[c].parameter >= 0) there.parameters[bound.coefficients[c].parameter].value = of_input;
    }
    out = {std::move(there), *request, request->effects.back().roles};
  } catch (const DoesNotSuit&) {  // it cannot act there: it stays at its port, its strength fixed at the whole
  }
  return out;
}

enum class Held { taken, refused, out_of_time };

/// Searches for the maximum with the whole effect in place of what was found.
class WholeSearch {
 public:
  WholeSearch(const RefitWork& work, Refit& out) : work_(work), out_(out) {}

  /// From a start; taken if its log-likelihood is not lower by `allowed`. A first search is not verified, which is most of the work:
  /// where it ends far lower, or where the search before this one ended, there is nothing to look for more closely. One that has not
  /// converged may still rise, but hardly from below the model without the effect to a whole one that matters.
  Held take_if_allowed(const WholeStart& start, const FilterNoise& noise, double allowed) {
    try {
      const double least = out_.estimate.objective - allowed;
      const FilterEstimate nearly = estimate(start.model, noise, {});
      if (nearly.out_of_time) return Held::out_of_time;
      highest_ = std::max(highest_, nearly.objective);
      if (is_far_below(nearly, least) && (nearly.converged || is_no_better_than_without(nearly))) return Held::refused;
      if (nearly.converged && is_where_the_last_ended(nearly)) return Held::refused;
      last_ = nearly.objective;
      FilterEstimate held = estimate(nearly.model, nearly.noise, least);
      if (held.out_of_time) return Held::out_of_time;
      if (!held.converged || !(held.objective > least)) return Held::refused;
      out_.estimate = std::move(held);
      out_.request = start.request;
      out_.moved = start.moved;
      return Held::taken;
    } catch (const TimeLimitReached&) {
      return Held::out_of_time;
    } catch (const RunError&) {  // the whole effect cannot be run there: a part of it is what was found
      return Held::refused;
    }
  }

  /// Of the drop of what was found, as the searches have ended.
  [[nodiscard]] double share_of_whole() const {
    const double without = work_.without.objective;
    return (highest_ - without) / std::max(out_.estimate.objective - without, std::numeric_limits<double>::min());
  }

 private:
  /// Verified where an objective is given that is of use.
  FilterEstimate estimate(const Model& model, const FilterNoise& noise, const std::optional<double>& least) const {
    FilterOptions options = options_like(work_.without, work_.threads);
    options.noise = noise;
    options.verify = least.has_value();
    options.least = least;
    return estimate_filter(model, penalties_as_of(work_.without, model), work_.experiments, options);
  }
  /// Verifying a search that has converged adds a few units to its log-likelihood, seldom twenty (where the likelihood is not smooth).
  static bool is_far_below(const FilterEstimate& nearly, double least) {
    constexpr double most_added = 30.0;
    return nearly.objective < least - most_added;
  }
  bool is_no_better_than_without(const FilterEstimate& nearly) const { return nearly.objective < work_.without.objective; }
  bool is_where_the_last_ended(const FilterEstimate& nearly) const {
    constexpr double same = 0.5;
    return last_ && std::abs(nearly.objective - *last_) < same;
  }

  const RefitWork& work_;
  Refit& out_;
  double highest_ = -std::numeric_limits<double>::infinity();  ///< [log-likelihood]
  std::optional<double> last_;                                 ///< [log-likelihood] where the search before ended, before it was verified
};

/// Of the shapes that the screening looked at, those with which the whole effect explains most at once, beside the estimate's values or the
/// study's own (an estimate without the effect may be far off); and the noise there. nullopt: there is no choice, or none can be run.
std::optional<std::pair<Model, FilterNoise>> best_screened_whole(const RefitWork& work, const ScreeningResult& screening,
                                                                 const std::vector<WholeStrength>& whole) {
  const CandidateModel& candidate_model = *screening.candidate_model;
  if (candidate_model.cells.size() < 2) return std::nullopt;
  std::optional<std::pair<Model, FilterNoise>> best;
  double highest = 0.0;
  for (Model model : {off_model(work, screening), fresh_model(work, screening)}) {
    for (const WholeStrength& w : whole) {
      model.parameters[w.parameter].value = w.value;
      model.parameters[w.parameter].free = false;
    }
    for (const auto& cell : candidate_model.cells) {
      for (std::size_t i = 0; i < cell.size() && i < candidate_model.shapes.size(); ++i)
        model.parameters[candidate_model.shapes[i]].value = cell[i];
      const std::optional<NoisyRun> there = run_once(work, model);
      if (!there || (best && !(there->objective > highest))) continue;
      highest = there->objective;
      best = {model, there->noise};
    }
  }
  return best;
}

/// The estimate from where the effect has a time constant of the system, and the system, by the parameter that moves it, the effect's. The
/// others are fitted first with these two fixed: a gain is far off then.
FilterEstimate with_exchanged_poles(const RefitWork& work, const FilterEstimate& estimate, const MovedPole& effect) {
  const FilterOptions options = options_like(work.without, work.threads);  // from its noise: the start is far from the maximum
  const auto from = [&](const Model& start) {
    return estimate_filter(start, penalties_as_of(work.without, start), work.experiments, options);
  };
  Model start = estimate.model;
  Parameter& tau = start.parameters[effect.parameter];
  const auto moved = moved_pole(estimate, effect.value, tau.value);
  tau.value = effect.value;
  if (!moved) return from(start);
  Parameter& of_system = start.parameters[moved->parameter];
  of_system.value = moved->value;
  tau.free = of_system.free = false;
  start = from(start).model;
  start.parameters[effect.parameter].free = start.parameters[moved->parameter].free = true;
  return from(start);
}

bool alike(double a, double b) {
  constexpr double factor = 1.25;  // of time constants
  return a < factor * b && b < factor * a;
}

}  // namespace

bool fix_whole_strengths(const RefitWork& work, const ScreeningResult& screening, Refit& out) {
  const std::vector<WholeStrength> whole = whole_strengths(out.estimate);
  if (whole.empty() || reads_whole_steps(out.estimate.model, out.estimate.model.effects.back())) return true;
  const ModelRequest as_requested = out.request;
  const double allowed = allowed_of_whole(work, out.estimate, whole);
  WholeSearch search(work, out);
  const auto hold = [&](const Model& model, const FilterNoise& noise, double cost) {
    return search.take_if_allowed(whole_start(work, model, as_requested), noise, cost);
  };
  const Held from_part = hold(start_of_whole(out.estimate.model, whole), out.estimate.noise, allowed);
  if (from_part == Held::out_of_time) return false;
  const bool taken = from_part == Held::taken;
  const auto screened = best_screened_whole(work, screening, whole);
  const Held from_screened = screened ? hold(screened->first, screened->second, taken ? 0.0 : allowed) : Held::refused;
  if (from_screened == Held::out_of_time) return taken;
  if (!taken && from_screened == Held::refused) out.partial = part_of_effect(out.estimate, whole, search.share_of_whole());
  return true;
}

void try_exchanged_poles(const RefitWork& work, Refit& out) {
  constexpr double hardly = 5.0;  // of the log-likelihood: a drop of 10
  const int time = time_constant_of(out.estimate.model);
  if (time < 0 || !out.estimate.converged) return;
  for (const double other : time_constants_of_system(out.estimate)) {
    const Parameter& tau = out.estimate.model.parameters[time];
    const double known = tau.value;
    if (other < tau.lower || other > tau.upper || alike(other, known)) continue;
    try {
      FilterEstimate there = with_exchanged_poles(work, out.estimate, {time, other});
      const double found = there.model.parameters[time].value;
      if (there.out_of_time || !there.converged || alike(found, known)) continue;
      const double gain = there.objective - out.estimate.objective;
      const bool taken = std::abs(gain) < hardly ? found < known : gain > 0.0;
      if (taken) std::swap(there, out.estimate);
      if (std::abs(gain) < hardly) {
        out.also = exchange_in_words(out.estimate, there, time);
      } else if (taken) {
        out.also.clear();  // of an order that was left
      }
    } catch (const TimeLimitReached&) {  // the order that was found stays
      return;
    } catch (const RunError&) {  // it cannot be run in that order
    }
  }
}

namespace {

/// A parameter of the model's last effect by which an input acts late: a delay of the input, or a clock of the outputs that is behind.
struct Lateness {
  int input = 0, parameter = 0;
  double sign = 1.0;  ///< of the parameter, where the input is late
};

std::vector<Lateness> lateness_of_last(const Model& model) {
  std::vector<Lateness> out;
  for (const LateInputUse& late : model.late_inputs()) {
    if (late.effect + 1 == std::ssize(model.effects)) out.push_back({late.input, late.delay});
  }
  const BoundEffect& last = model.effects.back();
  if (last.ports.empty() || last.effect->spec().ports.front().name != std::string_view(all_sample_times)) return out;
  for (int input = 0; input < std::ssize(model.system->spec().inputs); ++input)
    out.push_back({input, last.coefficients.front().parameter, -1.0});
  return out;
}

}  // namespace

void note_half_a_sample(Refit& out) {
  constexpr double sigmas = 3.0, sharp = 0.3, close = 0.1;  // of half an interval
  const Model& model = out.estimate.model;
  std::vector<std::string> inputs;
  double half = 0.0;
  bool straight = false;
  for (const Lateness& late : lateness_of_last(model)) {
    const InputSpec& input = model.system->spec().inputs[late.input];
    const auto sigma = standard_error_of(model, out.estimate.covariance, late.parameter);
    const double seconds = late.sign * model.parameters[late.parameter].value;
    if (!sigma) continue;
    const bool of_line = input.hold != Hold::zero_order;  // and should be held, which makes it late
    for (const FilterData& data : out.estimate.data) {
      const double half_step = 0.5 * usual_step(data.signals->t), off = std::abs(seconds - (of_line ? half_step : -half_step));
      if (*sigma > sharp * half_step || off > std::max(sigmas * *sigma, close * half_step)) continue;
      inputs.push_back(input.name);
      half = half_step;
      straight = of_line;
      break;
    }
  }
  if (inputs.empty()) return;
  constexpr const char *constant = "constant", *line = "a straight line";
  const char* hold = straight ? "zero_order" : "first_order";
  for (const std::string& input : inputs) out.holds.emplace(input, hold);
  out.also = fmt::format(
      "that is half a sampling interval ({:.4g} s), as an input seems shifted that the model takes as {} between its samples and that is "
      "{} there: if {} {}, its hold is "
      "\"{}\" ([system] hold of the study, or [inputs] of the system's file), which comes before this effect",
      half, straight ? line : constant, straight ? constant : line, join_words(inputs), inputs.size() == 1 ? "is one" : "are such", hold);
}

void note_output_as_late(Refit& out) {
  const Model& model = out.estimate.model;
  const SystemSpec& system = model.system->spec();
  const auto of_last = [&](const LateInputUse& late) { return late.effect + 1 == std::ssize(model.effects); };
  const std::vector<LateInputUse> late = model.late_inputs();
  if (!out.also.empty() || system.inputs.size() != 1 || system.outputs.size() != 1 || !std::any_of(late.begin(), late.end(), of_last))
    return;
  const auto is_whole = [&](const BoundCoefficient& c) {
    return c.parameter < 0 || model.parameters[c.parameter].kind == CoefficientKind::shape || !model.parameters[c.parameter].free;
  };
  const auto& coefficients = model.effects.back().coefficients;
  if (!std::all_of(coefficients.begin(), coefficients.end(), is_whole)) return;
  out.also = system.outputs.front().name + " late by as much, and " + system.inputs.front().name +
             " not, is the same: with one input and one output a recording cannot tell which of the two it is";
}

bool free_drifts(const RefitWork& work, Refit& out) {
  constexpr double rare = 1e-3;
  Model start = out.estimate.model;
  const std::vector<int> drifts = fixed_drifts(start);
  if (drifts.empty()) return true;
  for (const int drift : drifts) start.parameters[drift].free = true;
  FilterOptions options = options_like(work.without, work.threads);
  options.noise = out.estimate.noise;
  try {
    FilterEstimate drifting = estimate_filter(start, penalties_as_of(work.without, start), work.experiments, options);
    if (drifting.out_of_time) return false;
    const double drop = 2.0 * (drifting.objective - out.estimate.objective);
    if (drifting.converged && chi_square_tail(drop, static_cast<double>(drifts.size())) < rare) out.estimate = std::move(drifting);
  } catch (const TimeLimitReached&) {
    return false;
  } catch (const RunError&) {  // it cannot be run with a drift: it stays without
  }
  return true;
}

}  // namespace misfit
