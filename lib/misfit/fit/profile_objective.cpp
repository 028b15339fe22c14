#include "misfit/fit/profile_objective.h"

#include "misfit/core/error.h"

namespace misfit {
std::string why_no_profile(const Model& model, const std::string& name) {
  const int known = model.find_parameter(name);
  const bool of_a_curve = known >= 0 && model.parameters[known].curve >= 0;
  if (of_a_curve) return "is a coefficient of a curve, which means nothing alone; a profile is of a parameter";
  if (known >= 0 && model.parameters[known].free) return {};
  std::vector<std::string> free;
  for (const int i : model.free_parameters()) {
    const Parameter& p = model.parameters[i];
    if (p.curve < 0) free.push_back(p.name);
  }
  if (free.empty()) return "is not free: the model has no free parameter that is not a curve's coefficient";
  return (known >= 0 ? "is fixed in this study, and only a free parameter has a profile" : "is no free parameter of the model") +
         suggest(name, free);
}

ProfileObjective::ProfileObjective(FittedMethod from, const std::vector<Signals>& experiments, const std::string& parameter)
    : at_(std::move(from)), experiments_(&experiments) {
  if (!has_likelihood(at_.method))
    throw InputError("profile: " + at_.method + " has no likelihood of the motion; " + estimators_with_likelihood() + " have");
  const std::string why = why_no_profile(at_.fitted.model, parameter);
  if (!why.empty()) throw InputError("profile: '" + parameter + "' " + why);
  parameter_ = at_.fitted.model.find_parameter(parameter);
  at_.fitted.model = with_roughness(at_.fitted.model, at_.fitted.penalties);
  at_.fitted.model.parameters[parameter_].free = false;
  at_.fitted.penalties = curve_penalties(at_.fitted.model);  // columns without the parameter
}

std::optional<double> ProfileObjective::operator()(double value) {
  Parameter& held = at_.fitted.model.parameters[parameter_];
  held.value = value;
  const double prior = log_prior(held);
  Maximisation there = maximise_near(at_, *experiments_);
  if (!there.objective) return std::nullopt;
  at_ = std::move(there.at);
  return *there.objective + prior;
}

}  // namespace misfit
