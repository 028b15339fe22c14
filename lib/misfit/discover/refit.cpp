#include "misfit/discover/refit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/lists.h"
#include "misfit/core/text.h"
#include "misfit/core/watch.h"
#include "misfit/discover/drift.h"
#include "misfit/discover/refit_forms.h"
#include "misfit/discover/refit_sizes.h"
#include "misfit/discover/unknown_curves.h"
#include "misfit/discover/verdict.h"
#include "misfit/fit/filter/contained_start.h"
#include "misfit/fit/filter/likelihood_drop.h"
#include "misfit/inference/standard_error.h"
#include "misfit/model/whole_steps.h"

namespace misfit {
namespace {

std::vector<std::vector<SampleRole>> uses_of(const FilterEstimate& estimate) {
  std::vector<std::vector<SampleRole>> out;
  for (const auto& data : estimate.data) out.push_back(data.use);
  return out;
}

/// log prior density at all strengths 0 (effect off).
double prior_of_off(const CandidateModel& candidate_model) {
  return candidate_model.priors.log_density(Eigen::VectorXd::Zero(candidate_model.priors.mean.size()));
}

/// Rise of the objective that the Newton decrement of the exact derivatives predicts; 0 where the search has not converged: far from the
/// maximum the decrement means nothing.
double still_to_gain(const FilterEstimate& estimate) { return estimate.converged ? estimate.newton_decrement.value_or(0.0) : 0.0; }

/// Converged before not converged, then the higher objective.
bool better(const FilterEstimate& a, const FilterEstimate& b) {
  return a.converged != b.converged ? a.converged : a.objective > b.objective;
}

/// Held out: the last quarter of each experiment.
std::vector<std::vector<SampleRole>> without_last_quarter(const FilterEstimate& estimate) {
  std::vector<std::vector<SampleRole>> out = uses_of(estimate);
  for (auto& use : out) {
    for (std::size_t i = use.size() - use.size() / 4; i < use.size(); ++i) {
      if (use[i] == SampleRole::counted) use[i] = SampleRole::validation;
    }
  }
  return out;
}

/// Of the effect, which is the model's last.
std::map<std::string, Estimate> parameters_of_effect(const FilterEstimate& estimate, const ScreeningResult& screening) {
  std::map<std::string, Estimate> out;
  const CandidateModel& candidate_model = *screening.candidate_model;
  const BoundEffect& bound = estimate.model.effects.back();
  const std::vector<int> idle = fixed_drifts(estimate.model);
  for (std::size_t c = 0; c < bound.coefficients.size(); ++c) {
    const int at = bound.coefficients[c].parameter;
    if (at < 0 || bound.effect->spec().coefficients[c].shared || place_of(idle, at) >= 0) continue;
    const int strength = place_of(candidate_model.strengths, at);
    const Parameter& p = estimate.model.parameters[at];
    double sigma = standard_error_of(estimate.model, estimate.covariance, at).value_or(0.0);
    // With Kalman gains fixed the covariance of a sensor effect is too small (sensitivity_columns); screening uses whole runs.
    const bool screened = strength >= 0 && strength < screening.result.sigma.size();
    if (candidate_model.family == CandidateFamily::sensor && screened && p.free) sigma = screening.result.sigma[strength];
    out[p.name] = {p.value, sigma, p.unit};
  }
  return out;
}

/// A shape that a study keeps fixed but discovery looked for: the strength's interval holds for that value alone, so it is fitted too.
/// `i`: of the candidate model's shapes.
bool several_values_scanned(const CandidateModel& candidate_model, std::size_t i) {
  const auto& cells = candidate_model.cells;
  return i < candidate_model.shapes.size() &&
         std::any_of(cells.begin(), cells.end(), [&](const auto& cell) { return cell[i] != cells.front()[i]; });
}

/// Names of the effect's coefficients, as its file has them, that are free or fixed unlike there. A smoothing that ends at what the filter
/// resolves is not: with the wider bounds of a study it would go on to where a linear filter finds its effect too small.
void note_changes(const ScreeningResult& screening, const Registry& registry, Refit& out) {
  const Model as_filed = assemble(screening.candidate_model->request, registry);
  const BoundEffect& bound = out.estimate.model.effects.back();
  for (std::size_t c = 0; c < bound.coefficients.size(); ++c) {
    const int at = bound.coefficients[c].parameter;
    if (at < 0 || bound.effect->spec().coefficients[c].shared) continue;
    const Parameter& p = out.estimate.model.parameters[at];
    const bool at_resolution = bound.effect->spec().coefficients[c].scan.smooths && p.value <= 1.001 * p.lower;
    const bool free = p.free && !at_resolution;
    if (free == as_filed.parameters[at].free) continue;
    (free ? out.free : out.fixed).emplace_back(bound.effect->spec().coefficients[c].name);
  }
}

/// With what the exact derivatives leave where a search converged, priors on both sides.
double drop_of(const FilterEstimate& with, const FilterEstimate& without, const ScreeningResult& screening) {
  return likelihood_drop(with, without) + 2.0 * (still_to_gain(with) - still_to_gain(without) - prior_of_off(*screening.candidate_model));
}

/// A refit that is done, with what is said of it.
Refit with_what_is_said(const RefitWork& work, const ScreeningResult& screening, Refit out) {
  note_changes(screening, work.registry, out);
  out.drop = drop_of(out.estimate, work.without, screening);
  out.parameters = parameters_of_effect(out.estimate, screening);
  return out;
}

/// A start with an effect of whole steps, and measurements that are in them: held as a whole from the beginning, since no part of it is a
/// way there. nullopt: it is another effect, or they are not.
std::optional<Model> in_whole_steps(Model model, const RefitWork& work, const ScreeningResult& screening) {
  if (!on_whole_steps(model, work.experiments)) return std::nullopt;
  for (int strength : screening.candidate_model->strengths) {
    model.parameters[strength].value = 1.0;
    model.parameters[strength].free = false;
  }
  return reads_whole_steps(model, model.effects.back()) ? std::optional(std::move(model)) : std::nullopt;
}

}  // namespace

std::vector<Penalty> penalties_as_of(const FilterEstimate& from, const Model& model) {
  return with_weights_of(from, model, curve_penalties(model));
}

FilterOptions options_like(const FilterEstimate& estimate, int threads) {
  FilterOptions options;
  options.threads = threads;
  options.noise = estimate.noise;
  options.reference = estimate.reference;
  options.use = uses_of(estimate);
  options.plans = plans_of(estimate);
  options.choose_roughness = false;
  options.integration = estimate.data.front().inputs.plan.tolerance;
  return options;
}

Model start_model(const FilterEstimate& without, const ScreeningResult& screening, const Registry& registry) {
  const CandidateModel& candidate_model = *screening.candidate_model;
  Model model = assemble(candidate_model.request, registry);
  for (std::size_t i = 0; i < without.model.parameters.size(); ++i) {  // the effect's own follow behind; names may have changed
    model.parameters[i].value = without.model.parameters[i].value;
    model.parameters[i].free = without.model.parameters[i].free;
  }
  for (std::size_t i = 0; i < candidate_model.strengths.size(); ++i) {
    Parameter& p = model.parameters[candidate_model.strengths[i]];
    const Eigen::Index k = i;
    const Parameter& as_candidate = candidate_model.model.parameters[candidate_model.strengths[i]];
    p.lower = as_candidate.lower;
    p.upper = as_candidate.upper;
    p.value = std::clamp(screening.result.amplitude[k], p.lower, p.upper);
    p.free = true;
    if (candidate_model.priors.precision[k] > 0.0) {
      p.prior_sigma = 1.0 / std::sqrt(candidate_model.priors.precision[k]);
      p.prior_mean = candidate_model.priors.mean[k];
    }
  }
  for (std::size_t i = 0; i < screening.cell.size(); ++i) {
    const int shape = i < candidate_model.shapes.size() ? candidate_model.shapes[i] : candidate_model.frequency;
    Parameter& p = model.parameters[shape];
    p.value = screening.cell[i];
    p.lower = std::min(candidate_model.model.parameters[shape].lower, p.value);
    p.free |= several_values_scanned(candidate_model, i);
  }
  return model;
}

ScreeningResult as_refitted(const ScreeningResult& screening, const Model& refitted) {
  ScreeningResult out = screening;
  const CandidateModel& candidate_model = *screening.candidate_model;
  for (std::size_t i = 0; i < candidate_model.strengths.size(); ++i)
    out.result.amplitude[i] = refitted.parameters[candidate_model.strengths[i]].value;
  for (std::size_t i = 0; i < out.cell.size(); ++i) {
    const int shape = i < candidate_model.shapes.size() ? candidate_model.shapes[i] : candidate_model.frequency;
    out.cell[i] = refitted.parameters[shape].value;
  }
  return out;
}

Model with_the_same_values(Model moved, const Model& from) {
  for (std::size_t i = 0; i < moved.parameters.size(); ++i) {
    Parameter& p = moved.parameters[i];
    const Parameter& known = from.parameters[i];
    p.value = known.value;
    p.free = known.free;
    if (p.unit == known.unit) p.lower = known.lower;
  }
  return moved;
}

Model off_model(const RefitWork& work, const ScreeningResult& screening) {
  Model model = start_model(work.without, screening, work.registry);
  for (int strength : screening.candidate_model->strengths) {
    Parameter& p = model.parameters[strength];
    p.value = std::clamp(0.0, p.lower, p.upper);
  }
  return model;
}

Model fresh_model(const RefitWork& work, const ScreeningResult& screening) {
  Model model = start_model(work.without, screening, work.registry);
  const Model as_filed = assemble(screening.candidate_model->request, work.registry);
  for (std::size_t i = 0; i < work.without.model.parameters.size(); ++i) {
    Parameter& p = model.parameters[i];
    if (p.free) p.value = as_filed.parameters[i].value;
  }
  return model;
}

std::optional<NoisyRun> run_once(const RefitWork& work, const Model& model, const std::optional<FilterNoise>& given) {
  const FilterEstimate& without = work.without;
  const FilterNoise& with = given ? *given : without.noise;
  FilterModel forced = with_random_force(model);
  forced.set_force_time(with.force_time);
  FilterRunner runner(forced, false);
  runner.set_parameters(forced.model.values());
  std::vector<FilterData> data;
  std::vector<FilterTrace> traces(without.data.size());
  for (std::size_t e = 0; e < without.data.size(); ++e) {
    data.push_back(filter_data_like(forced, without.data[e]));
    if (!runner.run(data[e], with, traces[e], {.held_out = without.whole_runs})) return std::nullopt;
  }
  constexpr int steps_of_noise = 3;
  const NoiseFit noise = fit_noise({&forced, &data, &traces}, with, {without.reference, work.threads, steps_of_noise});
  return NoisyRun{-noise.minus_log_density + log_prior(model, penalties_as_of(without, model)), noise.noise};
}

OneStep one_step(const RefitWork& work, const ScoreTest& score, const ScreeningResult& screening) {
  const FilterEstimate& without = work.without;
  Model model = start_model(without, screening, work.registry);
  const Eigen::VectorXd step = score.adjusted_step(screening.columns, screening.result.amplitude);
  const std::vector<int> free = without.model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c) {
    Parameter& p = model.parameters[free[c]];
    p.value = std::clamp(p.value + step[c], p.lower, p.upper);
  }
  const std::optional<NoisyRun> there = run_once(work, model);
  if (!there) return {screening.result.chi2, std::nullopt, {}};
  const double drop = 2.0 * (there->objective - without.objective - prior_of_off(*screening.candidate_model));
  OneStep out{std::max(drop, screening.result.chi2), std::nullopt, there->noise};  // a step too long for the linearisation says nothing
  if (drop > 0.0) out.model = std::move(model);
  return out;
}

namespace {

/// [log-likelihood] What the model without the effect may lose where its refit has led, for a fit from there to be worth while.
double allowed_without(const PredictedRefit& of) {
  constexpr double small = 100.0;
  const bool more_than_predicted = of.refit->drop < small && of.refit->drop > of.predicted + tied_drops;
  return more_than_predicted ? 0.5 * of.predicted : -0.5 * tied_drops;
}

}  // namespace

std::optional<FilterEstimate> higher_without(const RefitWork& work, const std::vector<PredictedRefit>& refits) {
  const double least = work.without.objective + 0.5 * tied_drops;
  std::optional<FilterStart> start;
  double highest = -std::numeric_limits<double>::infinity();
  for (const PredictedRefit& of : refits) {
    Model model = work.without.model;
    for (std::size_t i = 0; i < model.parameters.size(); ++i) model.parameters[i].value = of.refit->estimate.model.parameters[i].value;
    const std::optional<NoisyRun> there = run_once(work, model, of.refit->estimate.noise);
    if (!there || !(there->objective > std::max(highest, work.without.objective - allowed_without(of)))) continue;
    highest = there->objective;
    start = {std::move(model), work.without.penalties, there->noise};
  }
  if (!start) return std::nullopt;
  FilterOptions options = options_like(work.without, work.threads);
  options.noise = start->noise;
  try {
    FilterEstimate out = estimate_filter(start->model, start->penalties, work.experiments, options);
    return out.objective > least ? std::optional(std::move(out)) : std::nullopt;
  } catch (const RunError&) {  // it is not needed
    return std::nullopt;
  }
}

Refit unfinished(const ScreeningResult& screening, const std::string& spent, std::optional<double> drop) {
  Refit out;
  out.request = screening.candidate_model->request;
  out.out_of_time = true;
  out.why = "its refit was not finished: " + spent + (drop ? ", at a drop of " + format_value(*drop) + " until then" : "") +
            "; that says nothing against it (more time: --time-limit SECONDS, or time_limit of [fit] and [discover])";
  return out;
}

namespace {

/// The searches of a refit, from one start after the other until one ends at a maximum.
class RefitSearch {
 public:
  RefitSearch(const RefitWork& work, const ScreeningResult& screening, const Watch& watch)
      : work_(work), screening_(screening), watch_(watch) {
    out_.request = screening.candidate_model->request;
  }

  Refit run(const OneStep& from) {
    const FilterEstimate& without = work_.without;
    if (const auto in_steps = in_whole_steps(start(), work_, screening_)) {
      if (!work_.afresh) estimate_from(*in_steps, without.noise);
      // Without the steps the estimate may be far off, with a random force that makes up for them.
      if (const auto fresh = in_whole_steps(fresh_model(work_, screening_), work_, screening_)) estimate_from(*fresh, std::nullopt);
      return std::move(out_);
    }
    if (work_.afresh) {
      estimate_from(fresh_model(work_, screening_), std::nullopt);
    } else {
      if (work_.rest != nullptr) estimate_from_the_rest();
      if (no_maximum() && from.model) estimate_from(*from.model, from.noise);
      if (no_maximum()) estimate_from(start(), without.noise);
      const double off = without.objective + prior_of_off(*screening_.candidate_model);
      if (no_maximum() || out_.estimate.objective < off) estimate_from(off_model(work_, screening_), without.noise);
    }
    if (fell_short()) estimate_from_held_shapes();
    return std::move(out_);
  }

 private:
  [[nodiscard]] Model start() const { return start_model(work_.without, screening_, work_.registry); }
  [[nodiscard]] bool no_maximum() const { return !out_.ok || !out_.estimate.converged; }

  void estimate_from_all(const std::vector<FilterStart>& starts, const std::optional<FilterNoise>& noise) {
    if (watch_.spent()) return;
    FilterOptions options = options_like(work_.without, work_.threads);
    options.noise = noise;
    try {
      FilterEstimate there = estimate_filter(starts, work_.experiments, options);
      if (!out_.ok || better(there, out_.estimate)) out_.estimate = std::move(there);
      out_.ok = true;
    } catch (const RunError& error) {
      out_.why = error.what();
    } catch (const TimeLimitReached&) {  // said by who asked
    }
  }
  void estimate_from(const Model& start, const std::optional<FilterNoise>& noise) {
    estimate_from_all({{start, penalties_as_of(work_.without, start)}}, noise);
  }
  void estimate_from_the_rest() {
    const Model start = start_model(*work_.rest, screening_, work_.registry);
    const std::vector<Penalty> penalties = penalties_as_of(work_.without, start);
    estimate_from_all({{start, penalties}, {start, penalties, std::nullopt, true}}, work_.rest->noise);
  }

  /// Of what its score promises. Where it was screened beside another estimate, that is no measure.
  [[nodiscard]] bool fell_short() const {
    if (work_.screened != nullptr || watch_.spent()) return false;
    return !out_.ok || drop_of(out_.estimate, work_.without, screening_) < least_of_score * screening_.result.chi2;
  }
  /// With its shapes as screened an effect is nearly linear, and its maximum near what its score promises; from there they are set free.
  void estimate_from_held_shapes() {
    Model held = work_.afresh ? fresh_model(work_, screening_) : start();
    std::vector<int> shapes = screening_.candidate_model->shapes;
    std::erase_if(shapes, [&](int shape) { return !held.parameters[shape].free; });
    if (shapes.empty()) return;
    for (const int shape : shapes) held.parameters[shape].free = false;
    FilterOptions options = options_like(work_.without, work_.threads);
    options.verify = false;
    try {
      const FilterEstimate there = estimate_filter(held, penalties_as_of(work_.without, held), work_.experiments, options);
      Model freed = there.model;
      for (const int shape : shapes) freed.parameters[shape].free = true;
      estimate_from(freed, there.noise);
    } catch (const RunError&) {  // what was found stays
    } catch (const TimeLimitReached&) {
    }
  }

  const RefitWork& work_;
  const ScreeningResult& screening_;
  const Watch& watch_;
  Refit out_;
};

Refit refit_in_time(const RefitWork& work, const ScreeningResult& screening, const OneStep& from, const Watch& watch) {
  Refit out = RefitSearch(work, screening, watch).run(from);
  const bool in_time = (out.ok && out.estimate.converged) || !watch.spent();
  if (!out.ok) return in_time ? out : unfinished(screening, watch.words());
  if (in_time) narrow_smoothings(work, out);
  if (in_time) shorten_numerical_times(work, out);
  if (in_time) fix_instant_strengths(work, out);
  const bool whole_tried = in_time && fix_whole_strengths(work, screening, out);
  if (whole_tried) try_exchanged_poles(work, out);
  note_half_a_sample(out);
  note_output_as_late(out);
  if (!whole_tried || !free_drifts(work, out)) return unfinished(screening, watch.words(), drop_of(out.estimate, work.without, screening));
  return with_what_is_said(work, screening, std::move(out));
}

}  // namespace

Refit refit(const RefitWork& work, const ScreeningResult& screening, const OneStep& from) {
  const Watch watch("the refit of " + screening.candidate_model->effect, work.time_limit);
  try {
    return refit_in_time(work, screening, from, watch);
  } catch (const TimeLimitReached& spent) {  // between its searches: whoever asked for it goes on without
    return unfinished(screening, spent.what());
  }
}

int estimated_parameters(const Refit& refit) {
  const Model& model = refit.estimate.model;
  const BoundEffect& added = model.effects.back();
  int out = 0;
  for (std::size_t c = 0; c < added.coefficients.size(); ++c) {
    const int parameter = added.coefficients[c].parameter;
    const bool own = parameter >= 0 && !added.effect->spec().coefficients[c].shared;
    out += own && model.parameters[parameter].free ? 1 : 0;
  }
  return out;
}

double least_held_out_gain(int parameters) { return 0.5 * parameters; }

double HeldOut::loglik(const FilterEstimate& estimate, const std::vector<double>& steps) const {
  const bool held_out = std::any_of(without_.traces.begin(), without_.traces.end(), [](const FilterTrace& t) { return t.validated > 0; });
  if (held_out) return predictive_loglik(estimate, steps);
  FilterOptions options = options_like(estimate, threads_);
  options.use = without_last_quarter(without_);
  options.verify = false;
  const FilterEstimate shorter = estimate_filter(estimate.model, estimate.penalties, experiments_, options);
  if (shorter.out_of_time) throw TimeLimitReached(Watch::current()->words());
  return predictive_loglik(shorter, steps);
}

double HeldOut::gain(const FilterEstimate& with) {
  const std::vector<double> steps = steps_of_one_alone(with, without_);
  if (!steps.empty()) return loglik(with) - loglik(without_, steps);
  if (!before_) before_ = loglik(without_);
  return loglik(with) - *before_;
}

double HeldOut::growth_ahead(const FilterEstimate& with) {
  if (!ahead_before_) ahead_before_ = k_step_errors(without_, ComparedSamples::both);
  return growth_of_errors(ahead_before_->rms, k_step_errors(with, ComparedSamples::both).rms);
}

}  // namespace misfit
