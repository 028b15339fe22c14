#include "misfit/fit/profile_objective.h"

#include <cmath>
#include <functional>

#include "misfit/core/error.h"
#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/regression/equation_error.h"

namespace misfit {
namespace {

/// The curves' roughness as chosen, so that any method keeps it.
Model with_roughness(Model model, const std::vector<Penalty>& penalties) {
  for (const auto& p : penalties) model.curves[static_cast<std::size_t>(p.curve)].roughness = p.lambda;
  return model;
}

FilterOptions filter_options(const FittedMethod& from) {
  FilterOptions options;
  options.threads = 1;
  options.noise = from.noise;
  options.around = from.around;
  options.choose_roughness = false;
  options.verify = false;
  return options;
}

OutputErrorStart quick_output_error() {
  OutputErrorStart options;
  options.coloured = false;
  options.keep_roughness = true;
  return options;
}

Fit refitted(const FittedMethod& from, const std::vector<Signals>& experiments) {
  const Model model = with_roughness(from.fitted.model, from.fitted.penalties);
  if (from.method == "equation_error") return equation_error(model, experiments).fit;
  FittedModel start = from.fitted;
  start.model = model;
  if (from.method == "filter_error") return filter_error(start, experiments, filter_options(from)).fit;
  return output_error(start, experiments, quick_output_error()).fit;
}

Maximisation by_output_error(const FittedMethod& from, const std::vector<Signals>& experiments, const OutputErrorStart& options) {
  const FittedModel end = output_error(from.fitted, experiments, options);
  if (end.fit.status != FitStatus::converged || !end.fit.loglik) return {{}, to_string(end.fit.status) + ": " + end.fit.message, {}};
  Maximisation out{*end.fit.loglik + log_prior(end.model, from.fitted.penalties), "", from};
  out.at.fitted.model.parameters = end.model.parameters;
  out.at.fitted.initial_states = end.initial_states;
  return out;
}

/// Verified: the noise at its restricted likelihood, as in the fit. Without that the two blocks drift to another maximum in turn.
Maximisation by_filter_error(const FittedMethod& from, const std::vector<Signals>& experiments, FilterOptions options) {
  options.use = from.use;
  options.verify = true;
  const FilterEstimate end = estimate_filter(from.fitted.model, from.fitted.penalties, experiments, options);
  if (!end.converged) return {{}, to_string(FitStatus::not_converged) + ": " + end.message, {}};
  Maximisation out{end.objective, "", from};
  out.at.fitted.model.parameters = end.model.parameters;
  out.at.noise = end.noise;
  return out;
}

/// What cannot be run has no maximum.
Maximisation reached(const std::function<Maximisation()>& search) {
  try {
    return search();
  } catch (const RunError& error) {
    return {{}, error.what(), {}};
  }
}

}  // namespace

Maximisation maximise_near(const FittedMethod& from, const std::vector<Signals>& experiments) {
  return reached([&] {
    return from.method == "output_error" ? by_output_error(from, experiments, quick_output_error())
                                         : by_filter_error(from, experiments, filter_options(from));
  });
}

Maximisation maximise_from(const FittedMethod& from, const std::vector<double>& values, const std::vector<Signals>& experiments) {
  FittedMethod start = from;
  start.fitted.model = with_roughness(std::move(start.fitted.model), start.fitted.penalties);
  for (std::size_t i = 0; i < values.size(); ++i) start.fitted.model.parameters[i].value = values[i];
  return reached([&] {
    if (start.method == "output_error") {
      start.fitted.initial_states.clear();
      OutputErrorStart options = quick_output_error();
      options.from_regression = false;
      return by_output_error(start, experiments, options);
    }
    FilterOptions options = filter_options(start);
    options.noise.reset();
    return by_filter_error(start, experiments, options);
  });
}

Fit fit_again(const FittedMethod& from, const std::vector<Signals>& experiments) {
  try {
    return refitted(from, experiments);
  } catch (const RunError& error) {
    Fit fit;
    fit.method = from.method;
    fit.message = error.what();
    return fit;
  }
}

bool has_likelihood(const std::string& method) { return method == "output_error" || method == "filter_error"; }

std::string why_no_profile(const Model& model, const std::string& name) {
  const int known = model.find_parameter(name);
  const bool of_a_curve = known >= 0 && model.parameters[static_cast<std::size_t>(known)].curve >= 0;
  if (of_a_curve) return "is a coefficient of a curve, which means nothing alone; a profile is of a parameter";
  if (known >= 0 && model.parameters[static_cast<std::size_t>(known)].free) return {};
  std::vector<std::string> free;
  for (const int i : model.free_parameters()) {
    const Parameter& p = model.parameters[static_cast<std::size_t>(i)];
    if (p.curve < 0) free.push_back(p.name);
  }
  if (free.empty()) return "is not free: the model has no free parameter that is not a curve's coefficient";
  return (known >= 0 ? "is held in this study, and only a free parameter has a profile" : "is no free parameter of the model") +
         suggest(name, free);
}

ProfileObjective::ProfileObjective(FittedMethod from, const std::vector<Signals>& experiments, const std::string& parameter)
    : at_(std::move(from)), experiments_(&experiments) {
  if (!has_likelihood(at_.method))
    throw InputError("profile: " + at_.method + " has no likelihood of the motion; output_error and filter_error have");
  const std::string why = why_no_profile(at_.fitted.model, parameter);
  if (!why.empty()) throw InputError("profile: '" + parameter + "' " + why);
  parameter_ = static_cast<std::size_t>(at_.fitted.model.find_parameter(parameter));
  const Parameter& p = at_.fitted.model.parameters[parameter_];
  prior_sigma_ = p.prior_sigma;
  prior_mean_ = p.prior_mean;
  at_.fitted.model = with_roughness(at_.fitted.model, at_.fitted.penalties);
  at_.fitted.model.parameters[parameter_].free = false;
  at_.fitted.penalties = curve_penalties(at_.fitted.model);  // columns without the parameter
}

std::optional<double> ProfileObjective::operator()(double value) {
  at_.fitted.model.parameters[parameter_].value = value;
  const double prior = prior_sigma_ ? -0.5 * std::pow((value - prior_mean_) / *prior_sigma_, 2) : 0.0;
  Maximisation there = maximise_near(at_, *experiments_);
  if (!there.objective) return std::nullopt;
  at_ = std::move(there.at);
  return *there.objective + prior;
}

}  // namespace misfit
