#include "misfit/discover/refit.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/lists.h"
#include "misfit/core/text.h"
#include "misfit/core/watch.h"
#include "misfit/discover/drift.h"
#include "misfit/discover/exchanged_poles.h"
#include "misfit/discover/whole_strength.h"
#include "misfit/fit/filter/contained_start.h"
#include "misfit/inference/standard_error.h"

namespace misfit {
namespace {

std::vector<std::vector<SampleRole>> uses_of(const FilterEstimate& estimate) {
  std::vector<std::vector<SampleRole>> out;
  for (const auto& data : estimate.data) out.push_back(data.use);
  return out;
}

std::vector<Penalty> penalties_as_of(const FilterEstimate& from, const Model& model) {
  return with_weights_of(from, model, curve_penalties(model));
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

/// Standard error of a parameter; 0 where it is fixed or no covariance is known.
double sigma_of(const FilterEstimate& estimate, int parameter) {
  return standard_error_of(estimate.model, estimate.covariance, parameter).value_or(0.0);
}

/// Of the effect, which is the model's last.
std::map<std::string, Estimate> parameters_of_effect(const FilterEstimate& estimate, const ScreeningResult& screening) {
  std::map<std::string, Estimate> out;
  const CandidateModel& candidate_model = *screening.candidate_model;
  const BoundEffect& bound = estimate.model.effects.back();
  const std::vector<int> idle = held_drifts(estimate.model);
  for (std::size_t c = 0; c < bound.coefficients.size(); ++c) {
    const int at = bound.coefficients[c].parameter;
    if (at < 0 || bound.effect->spec().coefficients[c].shared || place_of(idle, at) >= 0) continue;
    const int strength = place_of(candidate_model.strengths, at);
    const Parameter& p = estimate.model.parameters[at];
    double sigma = sigma_of(estimate, at);
    // With Kalman gains held the covariance of a sensor effect is too small (sensitivity_columns); screening uses whole runs.
    const bool screened = strength >= 0 && strength < screening.result.sigma.size();
    if (candidate_model.family == CandidateFamily::sensor && screened && p.free) sigma = screening.result.sigma[strength];
    out[p.name] = {p.value, sigma, p.unit};
  }
  return out;
}

/// Where a part of the effect is found, the whole with a memory so much shorter looks nearly the same.
Model start_of_whole(const Model& part, const std::vector<WholeStrength>& whole) {
  Model start = part;
  for (const WholeStrength& w : whole) {
    Parameter& p = start.parameters[w.parameter];
    const double share = std::abs(p.value / w.value);
    p.value = w.value;
    p.free = false;
    for (const BoundCoefficient& c : part.effects.back().coefficients) {
      if (c.parameter < 0 || start.parameters[c.parameter].unit != "s") continue;
      Parameter& time = start.parameters[c.parameter];
      time.value = std::clamp(share * time.value, std::max(time.lower, 1e-3 * time.value), time.upper);
    }
  }
  return start;
}

/// What the effect leaves in steps may have had noise before: of a sawtooth of the prediction that leaves the mean over that noise, a part
/// (its first harmonic is exp(-2 pi^2 sigma^2/step^2) as large). The steps themselves are looked for in the measurements
/// (off_whole_steps()).
bool rounds(const BoundEffect& effect) {
  const auto& coefficients = effect.effect->spec().coefficients;
  return std::any_of(coefficients.begin(), coefficients.end(),
                     [](const CoefficientSpec& c) { return c.measured_as == OfMeasurements::step; });
}

/// "late_share = 0.12 ± 0.01, where the whole effect would have 1.00"; empty where the strengths are about whole.
std::string part_of_effect(const FilterEstimate& estimate, const std::vector<WholeStrength>& whole) {
  constexpr double more = 0.2;  // of the whole: formulas idealise, which takes away rather than adds
  const double less = rounds(estimate.model.effects.back()) ? 0.9 : 0.3;
  for (const WholeStrength& w : whole) {
    const Parameter& p = estimate.model.parameters[w.parameter];
    const double sigma = sigma_of(estimate, w.parameter);
    const double share = p.value / w.value, of_sigma = 2.0 * sigma / std::abs(w.value);
    if (share >= 1.0 - std::max(less, of_sigma) && share <= 1.0 + std::max(more, of_sigma)) continue;
    return p.name + " = " + in_display_unit(p.value, p.unit, sigma) + ", where the whole effect would have " +
           in_display_unit(w.value, p.unit);
  }
  return {};
}

/// A shape that a study keeps fixed but discovery looked for: the strength's interval holds for that value alone, so it is fitted too.
/// `i`: of the candidate model's shapes.
bool several_values_scanned(const CandidateModel& candidate_model, std::size_t i) {
  const auto& cells = candidate_model.cells;
  return i < candidate_model.shapes.size() &&
         std::any_of(cells.begin(), cells.end(), [&](const auto& cell) { return cell[i] != cells.front()[i]; });
}

/// A start with the whole effect, and what it was assembled from.
struct WholeStart {
  Model model;
  ModelRequest request;
  std::optional<std::map<std::string, std::string>> moved;
};

/// On the input itself where that is possible: on_its_input().
WholeStart whole_start(const RefitWork& work, const Refit& refit, const std::vector<WholeStrength>& whole) {
  WholeStart out{start_of_whole(refit.estimate.model, whole), refit.request, {}};
  const std::optional<ModelRequest> request = on_its_input(refit.estimate.model, refit.request);
  if (!request) return out;
  try {
    Model there = with_the_same_values(assemble(*request, work.registry), out.model);
    const BoundEffect& bound = there.effects.back();
    for (std::size_t c = 0; c < bound.coefficients.size(); ++c) {
      const double of_input = bound.effect->spec().coefficients[c].whole;
      if (of_input != 0.0 && bound.coefficients[c].parameter >= 0) there.parameters[bound.coefficients[c].parameter].value = of_input;
    }
    out = {std::move(there), *request, request->effects.back().roles};
  } catch (const InputError&) {  // it cannot act there: its strength is held at a number
  }
  return out;
}

/// Holds the strengths of an effect that exists as a whole only (CoefficientSpec::whole) at that value, if the log-likelihood allows it.
/// False: there was no time to try, so that a part that was found says nothing.
bool fix_whole_strengths(const RefitWork& work, Refit& out) {
  constexpr double allowed = 2.0;  // of the log-likelihood
  const std::vector<WholeStrength> whole = whole_strengths(out.estimate);
  if (whole.empty()) return true;
  const WholeStart start = whole_start(work, out, whole);
  FilterOptions options = options_like(work.without, work.threads);
  options.noise = out.estimate.noise;
  try {
    FilterEstimate held = estimate_filter(start.model, penalties_as_of(work.without, start.model), work.experiments, options);
    if (held.out_of_time) return false;
    if (held.converged && held.objective > out.estimate.objective - allowed) {
      out.estimate = std::move(held);
      out.request = start.request;
      out.moved = start.moved;
      return true;
    }
  } catch (const TimeSpent&) {
    return false;
  } catch (const RunError&) {  // the whole effect cannot be run there: a part of it is what was found
  }
  out.partial = part_of_effect(out.estimate, whole);
  return true;
}

/// The estimate from where the effect has a time constant of the system, and the system, by the parameter that moves it, the effect's. The
/// others are fitted first with these two held: a gain is far off then.
FilterEstimate with_exchanged_poles(const RefitWork& work, const FilterEstimate& estimate, const MovedPole& effect) {
  const FilterOptions options = options_like(work.without, work.threads);  // with its noise: the way is long
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

/// Where the effect's time constant and one of the system's may have changed places: the better order. Where these data hardly tell the two
/// apart, the one in which the effect is the faster, as actuators and sensors are, and the other in words. False: there was no time to try.
bool try_exchanged_poles(const RefitWork& work, Refit& out) {
  constexpr double hardly = 5.0;  // of the log-likelihood: a drop of 10
  const int time = time_constant_of(out.estimate.model);
  if (time < 0 || !out.estimate.converged) return true;
  for (const double other : time_constants_of_system(out.estimate)) {
    const double known = out.estimate.model.parameters[time].value;
    const Parameter& tau = out.estimate.model.parameters[time];
    constexpr double alike = 1.25;
    if (other < tau.lower || other > tau.upper || (other < alike * known && known < alike * other)) continue;
    try {
      FilterEstimate there = with_exchanged_poles(work, out.estimate, {time, other});
      if (there.out_of_time) return false;
      const double found = there.model.parameters[time].value;
      if (!there.converged || (found < alike * known && known < alike * found)) continue;
      const double gain = there.objective - out.estimate.objective;
      if (std::abs(gain) < hardly ? found < known : gain > 0.0) std::swap(there, out.estimate);
      if (std::abs(gain) < hardly) out.also = exchange_in_words(out.estimate, there, time);
    } catch (const TimeSpent&) {
      return false;
    } catch (const RunError&) {  // it cannot be run in that order
    }
  }
  return true;
}

/// Frees the drifts of its shapes (CoefficientSpec::drift_of), if that gains what chance would once in a thousand times. False: there was
/// no time to try.
bool free_drifts(const RefitWork& work, Refit& out) {
  constexpr double least = 5.4;  // of the log-likelihood: 10.8 in chi², 1 degree of freedom
  Model start = out.estimate.model;
  const std::vector<int> drifts = held_drifts(start);
  if (drifts.empty()) return true;
  for (const int drift : drifts) start.parameters[drift].free = true;
  FilterOptions options = options_like(work.without, work.threads);
  options.noise = out.estimate.noise;
  try {
    FilterEstimate drifting = estimate_filter(start, penalties_as_of(work.without, start), work.experiments, options);
    if (drifting.out_of_time) return false;
    const double needed = least * static_cast<double>(drifts.size());
    if (drifting.converged && drifting.objective > out.estimate.objective + needed) out.estimate = std::move(drifting);
  } catch (const TimeSpent&) {
    return false;
  } catch (const RunError&) {  // it cannot be run with a drift: it stays without
  }
  return true;
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
  return 2.0 *
         (with.objective + still_to_gain(with) - without.objective - still_to_gain(without) - prior_of_off(*screening.candidate_model));
}

}  // namespace

FilterOptions options_like(const FilterEstimate& estimate, int threads) {
  FilterOptions options;
  options.threads = threads;
  options.noise = estimate.noise;
  options.around = estimate.around;
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
    p.lower = candidate_model.model.parameters[candidate_model.strengths[i]].lower;
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
    p.lower = candidate_model.model.parameters[shape].lower;
    p.free |= several_values_scanned(candidate_model, i);
  }
  return model;
}

ScreeningResult as_refitted(const ScreeningResult& screening, const Model& refitted) {
  ScreeningResult out = screening;
  const CandidateModel& candidate_model = *screening.candidate_model;
  for (std::size_t i = 0; i < candidate_model.strengths.size(); ++i)
    out.result.amplitude[static_cast<Eigen::Index>(i)] = refitted.parameters[candidate_model.strengths[i]].value;
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

/// The estimate with the effect in it, off: a start below which no search ends.
Model off_model(const RefitWork& work, const ScreeningResult& screening) {
  Model model = start_model(work.without, screening, work.registry);
  for (int strength : screening.candidate_model->strengths) {
    Parameter& p = model.parameters[strength];
    p.value = std::clamp(0.0, p.lower, p.upper);
  }
  return model;
}

namespace {

/// With the study's own values of what is in the estimate: the estimate's may be what makes up for the missing effect, together with a
/// random force that hides it, and no way up may lead from there to the maximum with the effect.
Model fresh_model(const RefitWork& work, const ScreeningResult& screening) {
  Model model = start_model(work.without, screening, work.registry);
  const Model as_filed = assemble(screening.candidate_model->request, work.registry);
  for (std::size_t i = 0; i < work.without.model.parameters.size(); ++i) {
    Parameter& p = model.parameters[i];
    if (p.free) p.value = as_filed.parameters[i].value;
  }
  return model;
}

}  // namespace

OneStep one_step(const RefitWork& work, const ScoreTest& score, const ScreeningResult& screening) {
  const FilterEstimate& without = work.without;
  Model model = start_model(without, screening, work.registry);
  const Eigen::VectorXd step = score.adjusted_step(screening.columns, screening.result.amplitude);
  const std::vector<int> free = without.model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c) {
    Parameter& p = model.parameters[free[c]];
    p.value = std::clamp(p.value + step[c], p.lower, p.upper);
  }
  FilterModel forced = with_random_force(model);
  forced.set_force_time(without.noise.force_time);
  FilterRunner runner(forced, false);
  runner.set_parameters(forced.model.values());
  std::vector<FilterData> data;
  std::vector<FilterTrace> traces(without.data.size());
  for (std::size_t e = 0; e < without.data.size(); ++e) {
    data.push_back(filter_data_like(forced, without.data[e]));
    if (!runner.run(data[e], without.noise, traces[e])) return {screening.result.chi2, std::nullopt, {}};
  }
  constexpr int steps_of_noise = 3;
  const NoiseFit noise = fit_noise({&forced, &data, &traces}, without.noise, {without.around, work.threads, steps_of_noise});
  const double objective = -noise.minus_log_density + log_prior(model, penalties_as_of(without, model));
  const double drop = 2.0 * (objective - without.objective - prior_of_off(*screening.candidate_model));
  OneStep out{std::max(drop, screening.result.chi2), std::nullopt, noise.noise};  // a step too long for the linearisation says nothing
  if (drop > 0.0) out.model = std::move(model);
  return out;
}

Refit unfinished(const ScreeningResult& screening, const std::string& spent, std::optional<double> drop) {
  Refit out;
  out.request = screening.candidate_model->request;
  out.out_of_time = true;
  out.why = "its refit was not finished: " + spent + (drop ? ", at a drop of " + format_value(*drop) + " until then" : "") +
            "; that says nothing against it (more time: --time-limit SECONDS, or time_limit of [fit] and [discover])";
  return out;
}

Refit refit(const RefitWork& work, const ScreeningResult& screening, const OneStep& from) {
  const Watch watch("the refit of " + screening.candidate_model->effect, work.time_limit);
  const FilterEstimate& without = work.without;
  Refit out;
  out.request = screening.candidate_model->request;
  const auto estimate_from = [&](const Model& start, const std::optional<FilterNoise>& noise) {
    if (watch.spent()) return;
    FilterOptions options = options_like(without, work.threads);
    options.noise = noise;
    try {
      FilterEstimate there = estimate_filter(start, penalties_as_of(without, start), work.experiments, options);
      if (!out.ok || better(there, out.estimate)) out.estimate = std::move(there);
      out.ok = true;
    } catch (const RunError& error) {
      out.why = error.what();
    } catch (const TimeSpent&) {  // said below
    }
  };
  const auto no_maximum = [&] { return !out.ok || !out.estimate.converged; };
  if (work.afresh) {
    estimate_from(fresh_model(work, screening), std::nullopt);
  } else {
    if (from.model) estimate_from(*from.model, from.noise);
    if (no_maximum()) estimate_from(start_model(without, screening, work.registry), without.noise);
    const double off = without.objective + prior_of_off(*screening.candidate_model);
    if (no_maximum() || out.estimate.objective < off) estimate_from(off_model(work, screening), without.noise);
  }
  const bool in_time = !no_maximum() || !watch.spent();
  if (!in_time && !out.ok) return unfinished(screening, watch.words());
  if (!out.ok) return out;
  if (!in_time || !fix_whole_strengths(work, out) || !try_exchanged_poles(work, out) || !free_drifts(work, out))
    return unfinished(screening, watch.words(), drop_of(out.estimate, without, screening));
  note_changes(screening, work.registry, out);
  out.drop = drop_of(out.estimate, without, screening);
  out.parameters = parameters_of_effect(out.estimate, screening);
  return out;
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

double HeldOut::loglik(const FilterEstimate& estimate) const {
  const bool held_out = std::any_of(without_.traces.begin(), without_.traces.end(), [](const FilterTrace& t) { return t.validated > 0; });
  if (held_out) return predictive_loglik(estimate);
  FilterOptions options = options_like(estimate, threads_);
  options.use = without_last_quarter(without_);
  options.verify = false;
  const FilterEstimate shorter = estimate_filter(estimate.model, estimate.penalties, experiments_, options);
  if (shorter.out_of_time) throw TimeSpent(Watch::current()->words());
  return predictive_loglik(shorter);
}

double HeldOut::gain(const FilterEstimate& with) {
  if (!before_) before_ = loglik(without_);
  return loglik(with) - *before_;
}

}  // namespace misfit
