#include "misfit/fit/methods.h"

#include <algorithm>
#include <array>

#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/core/watch.h"
#include "misfit/fit/filter/contained_start.h"
#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/filter/runnable_start.h"
#include "misfit/fit/regression/equation_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "misfit/fit/trajectory_start.h"

namespace misfit {
namespace {

using Experiments = std::vector<Signals>;

/// The fitted model with its roughness as chosen.
FittedModel with_own_roughness(FittedModel fitted) {
  fitted.model = with_roughness(std::move(fitted.model), fitted.penalties);
  return fitted;
}

/// The model with the values that it has and roughness to be chosen, without a fit: where a search begins.
FittedModel at_own_values(const Model& model) {
  FittedModel out;
  out.model = model;
  out.penalties = curve_penalties(model);
  return out;
}

Estimation estimation_by(const EstimatorInfo& method) {
  Estimation out;
  out.at.method = method.name;
  return out;
}

Maximisation no_maximum(const std::string& why) {
  Maximisation out;
  out.why = why;
  return out;
}

// sliding_bin

Estimation run_sliding_bin(const EstimationTask& task) {
  Estimation out = estimation_by(estimators::sliding_bin);
  out.at.fitted.model = task.model;
  out.at.fitted.fit = sliding_bin(task.model, task.experiments.front(), task.bins);
  out.at.bins = task.bins;
  return out;
}

Fit refit_sliding_bin(const FittedMethod& from, const Experiments& experiments) {
  return sliding_bin(from.fitted.model, experiments.front(), from.bins);
}

// equation_error

Estimation run_equation_error(const EstimationTask& task) {
  Estimation out = estimation_by(estimators::equation_error);
  out.at.fitted = task.regression ? task.regression() : equation_error(task.model, task.experiments);
  return out;
}

Fit refit_equation_error(const FittedMethod& from, const Experiments& experiments) {
  return equation_error(with_own_roughness(from.fitted).model, experiments).fit;
}

// output_error

/// A regression on noisy derivatives can end at values from which the model cannot be run.
std::string begun_at_own_values(const std::string& why) {
  return "the model cannot be run from the regression's values (" + why + "): the search began at the study's own";
}

Estimation run_output_error(const EstimationTask& task) {
  TrajectoryStart start = trajectory_start(task.model, task.experiments, task.regression);
  Estimation out = estimation_by(estimators::output_error);
  if (!start.regressed && task.model.free_parameters().empty()) {
    out.at.fitted = std::move(start.from);
    out.at.fitted.fit.method = estimators::output_error.name;
    return out;
  }
  OutputErrorStart options;
  options.from_regression = start.regressed;
  out.at.fitted = output_error(start.from, task.experiments, options);
  if (out.at.fitted.fit.status != FitStatus::failed || !start.regressed) return out;
  // The short segments that rough values need cannot be run where a few samples say too little of a state; then without them.
  for (const bool longer_segments : {false, true}) {
    options.from_regression = longer_segments;
    FittedModel own = output_error(at_own_values(task.model), task.experiments, options);
    if (!own.fit.usable()) continue;
    own.fit.warnings.push_back(begun_at_own_values(out.at.fitted.fit.message));
    out.at.fitted = std::move(own);
    break;
  }
  return out;
}

OutputErrorStart quick_output_error() {
  OutputErrorStart options;
  options.thorough = false;
  options.keep_roughness = true;
  return options;
}

Fit refit_output_error(const FittedMethod& from, const Experiments& experiments) {
  return output_error(with_own_roughness(from.fitted), experiments, quick_output_error()).fit;
}

Maximisation maximise_output_error(const FittedMethod& from, const Experiments& experiments, const SearchStart& begin) {
  FittedModel start = from.fitted;
  OutputErrorStart options = quick_output_error();
  if (!begin.fitted) {
    start.initial_states.clear();
    options.from_regression = false;
  }
  const FittedModel end = output_error(start, experiments, options);
  if (end.fit.status != FitStatus::converged || !end.fit.loglik) return no_maximum(to_string(end.fit.status) + ": " + end.fit.message);
  Maximisation out{*end.fit.loglik + log_prior(end.model, from.fitted.penalties), "", from};
  out.at.fitted.model.parameters = end.model.parameters;
  out.at.fitted.initial_states = end.initial_states;
  return out;
}

// filter_error

/// By output error, where the model follows the motion without a random force; nullopt where it does not, or not in time.
std::optional<FilterStart> free_start(const Model& start, const EstimationTask& task, bool from_regression) {
  try {
    if (!follows_freely(start, task.experiments)) return std::nullopt;
    if (start.free_parameters().empty()) return FilterStart{.model = start, .penalties = curve_penalties(start), .freely = true};
    OutputErrorStart options;
    options.thorough = false;
    options.from_regression = from_regression;
    const FittedModel fitted = output_error(at_own_values(start), task.experiments, options);
    if (!fitted.fit.usable()) return std::nullopt;
    return FilterStart{.model = fitted.model, .penalties = curve_penalties(fitted.model), .freely = true};
  } catch (const RunError&) {
    return std::nullopt;
  }
}

/// The first parameter of the system, a number, that has the opposite sign of what the study gives; empty: none. Noise of differentiated
/// channels draws what a regression finds towards 0, and what the model lacks may draw it beyond: a search from there ends at a maximum on
/// the wrong side of 0.
std::string changed_sign(const Model& given, const Model& found) {
  for (std::size_t k = 0; k < given.system->spec().constants.size(); ++k) {
    const Parameter& p = given.parameters[k];
    if (p.free && p.curve < 0 && p.value * found.parameters[k].value < 0.0) return p.name;
  }
  return {};
}

struct FilterStarts {
  std::vector<FilterStart> list;
  std::string warning = {};
};

/// From the contained fit with what is new off, and as the study has it; then by regression with the effects as the study has them where
/// it says so, with the effects off, and with what the regression makes of them, in a free run too; from the study's own values where the
/// regression has changed a sign.
FilterStarts filter_starts(const EstimationTask& task) {
  FilterStarts out{task.contained ? starts_from(*task.contained, task.model) : std::vector<FilterStart>{}};
  const auto add = [&](const Model& model) { out.list.push_back({model, curve_penalties(model)}); };
  const RunnableStart off = with_strengths_off(task.model);
  if (!off.words.empty()) add(trajectory_start_as_given(task.model, task.experiments)->from.model);
  if (const auto held = trajectory_start_as_given(off.model, task.experiments)) add(held->from.model);
  add(trajectory_start(task.model, task.experiments, task.regression).from.model);
  if (task.contained && !task.contained->refit_values.empty()) return out;
  const std::string changed = changed_sign(task.model, out.list.back().model);
  if (auto freely = free_start(out.list.back().model, task, true)) out.list.push_back(std::move(*freely));
  if (changed.empty()) return out;
  add(off.model);
  out.warning = "the regression changes the sign of " + changed + ": the search began at the study's own values, too";
  return out;
}

Estimation run_filter_error(const EstimationTask& task) {
  FilterOptions options;
  options.threads = task.threads;
  if (task.contained && contains(task.model, *task.contained)) {
    options.reference = usual_noise_of(*task.contained, task.model);
    options.use = same_use(*task.contained, task.experiments);
  }
  const FilterStarts starts = filter_starts(task);
  FilterErrorFit result = filter_error(starts.list, task.experiments, options);
  if (result.estimate && !starts.warning.empty()) result.fit.warnings.push_back(starts.warning);
  if (!result.estimate) {
    std::vector<FilterStart> own = {{task.model, curve_penalties(task.model)}};
    if (auto freely = free_start(task.model, task, false)) own.push_back(std::move(*freely));
    FilterErrorFit again = filter_error(own, task.experiments, options);
    if (again.estimate) {
      again.fit.warnings.push_back(begun_at_own_values(result.fit.message));
      result = std::move(again);
    }
  }
  Estimation out = estimation_by(estimators::filter_error);
  out.at.fitted.fit = std::move(result.fit);
  out.at.fitted.model = task.model;
  out.filter = std::move(result.estimate);
  if (!out.filter) return out;
  out.at.fitted.model = out.filter->model;
  out.at.fitted.penalties = out.filter->penalties;
  out.at.noise = out.filter->noise;
  out.at.reference = out.filter->reference;
  out.at.use.emplace();
  for (const auto& data : out.filter->data) out.at.use->push_back(data.use);
  return out;
}

FilterOptions warm_filter(const FittedMethod& from) {
  FilterOptions options;
  options.threads = 1;
  options.noise = from.noise;
  options.reference = from.reference;
  options.choose_roughness = false;
  options.verify = false;
  return options;
}

Fit refit_filter_error(const FittedMethod& from, const Experiments& experiments) {
  return filter_error(with_own_roughness(from.fitted), experiments, warm_filter(from)).fit;
}

/// Verified: the noise at its restricted likelihood, as in the fit. Without that the two blocks drift to another maximum in turn.
Maximisation maximise_filter_error(const FittedMethod& from, const Experiments& experiments, const SearchStart& begin) {
  FilterOptions options = warm_filter(from);
  if (!begin.fitted) {
    options.noise.reset();
    options.noise_factors = begin.noise_factors;
  }
  options.use = from.use;
  options.verify = true;
  const FilterEstimate end = estimate_filter(from.fitted.model, from.fitted.penalties, experiments, options);
  if (!end.converged) return no_maximum(to_string(FitStatus::not_converged) + ": " + end.message);
  Maximisation out{end.objective, "", from};
  out.at.fitted.model.parameters = end.model.parameters;
  out.at.noise = end.noise;
  return out;
}

constexpr std::array table{
    Estimator{.info = estimators::sliding_bin, .run = run_sliding_bin, .refit = refit_sliding_bin, .maximise = nullptr},
    Estimator{.info = estimators::equation_error, .run = run_equation_error, .refit = refit_equation_error, .maximise = nullptr},
    Estimator{.info = estimators::output_error, .run = run_output_error, .refit = refit_output_error, .maximise = maximise_output_error},
    Estimator{.info = estimators::filter_error, .run = run_filter_error, .refit = refit_filter_error, .maximise = maximise_filter_error},
};

/// What cannot be run, or not in time, has no maximum.
Maximisation maximise(const FittedMethod& from, const Experiments& experiments, const SearchStart& start) {
  const Watch watch("a search by " + from.method, from.time_limit);
  try {
    Maximisation out = estimator(from.method).maximise(from, experiments, start);
    if (!out.objective && watch.spent()) out.why = watch.words();
    return out;
  } catch (const RunError& error) {
    return no_maximum(error.what());
  } catch (const TimeLimitReached&) {
    return no_maximum(watch.words());
  }
}

}  // namespace

const Estimator& estimator(const std::string& name) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const Estimator& e) { return e.info.name == name; });
  if (found == table.end()) throw InputError("there is no method '" + name + "'" + suggest(name, estimator_names()));
  return *found;
}

Fit refit_in_time(const FittedMethod& from, const Experiments& experiments) {
  const Watch watch("a refit by " + from.method, from.time_limit);
  try {
    Fit fit = estimator(from.method).refit(from, experiments);
    if (fit.status == FitStatus::converged || !watch.spent()) return fit;
  } catch (const TimeLimitReached&) {  // said below
  }
  throw RunError(watch.words());
}

Fit fit_again(const FittedMethod& from, const Experiments& experiments) {
  try {
    return refit_in_time(from, experiments);
  } catch (const RunError& error) {
    Fit fit;
    fit.method = from.method;
    fit.message = error.what();
    return fit;
  }
}

Maximisation maximise_near(const FittedMethod& from, const Experiments& experiments) { return maximise(from, experiments, {}); }

Maximisation maximise_from(const FittedMethod& from, const AnotherStart& start, const Experiments& experiments) {
  FittedMethod there = from;
  there.fitted = with_own_roughness(std::move(there.fitted));
  Model& model = there.fitted.model;
  for (std::size_t i = 0; i < start.values.size(); ++i) model.parameters[i].value = start.values[i];
  const auto& outputs = model.system->spec().outputs;
  for (std::size_t o = 0; o < outputs.size() && o < start.noise_factors.size(); ++o) {
    const auto noise = there.fitted.fit.noise.find(outputs[o].name);
    if (noise != there.fitted.fit.noise.end() && !model.known_noise[o].fixed) noise->second.value *= start.noise_factors[o];
  }
  return maximise(there, experiments, {false, start.noise_factors});
}

}  // namespace misfit
