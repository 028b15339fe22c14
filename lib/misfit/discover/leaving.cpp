#include "misfit/discover/leaving.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/lists.h"
#include "misfit/core/watch.h"
#include "misfit/discover/operating_range.h"
#include "misfit/discover/refit.h"
#include "misfit/fit/filter/contained_start.h"
#include "misfit/fit/filter/likelihood_drop.h"
#include "misfit/inference/standard_error.h"
#include "misfit/math/statistics.h"
#include "misfit/model/does_not_suit.h"
#include "misfit/model/model.h"

namespace misfit {
namespace {

const BoundEffect* effect_called(const Model& model, const std::string& name) {
  const auto found = std::find_if(model.effects.begin(), model.effects.end(), [&](const BoundEffect& e) { return e.name == name; });
  return found == model.effects.end() ? nullptr : &*found;
}

/// Parameters of a coefficient: one, or those of its curve.
std::vector<int> parameters_of(const Model& model, const BoundCoefficient& coefficient) {
  if (coefficient.curve < 0) return coefficient.parameter < 0 ? std::vector<int>{} : std::vector<int>{coefficient.parameter};
  std::vector<int> out;
  const Curve& curve = model.curves[coefficient.curve];
  for (int i = 0; i < curve.spline.size(); ++i) out.push_back(curve.first + i);
  return out;
}

/// Of an effect's own coefficients.
std::vector<int> own_parameters(const Model& model, const BoundEffect& effect) {
  std::vector<int> out;
  for (std::size_t c = 0; c < effect.coefficients.size(); ++c) {
    if (effect.effect->spec().coefficients[c].shared) continue;
    const std::vector<int> these = parameters_of(model, effect.coefficients[c]);
    out.insert(out.end(), these.begin(), these.end());
  }
  return out;
}

/// Does the first effect that has a coefficient of this bare name come before `effect`?
bool comes_after_another_with(const std::string& bare, const Model& model, const BoundEffect& effect) {
  for (const BoundEffect& other : model.effects) {
    if (other.name == effect.name) return false;
    const std::string full = other.name + "." + bare;
    const auto is_it = [&](const auto& named) { return named.name == full; };
    if (std::any_of(model.parameters.begin(), model.parameters.end(), is_it)) return true;
    if (std::any_of(model.curves.begin(), model.curves.end(), is_it)) return true;
  }
  return false;
}

/// How a study may call a coefficient of an effect: by its name in the model, and of several effects that have one of that name, the first
/// one's also by that name alone.
std::vector<std::string> names_in_request(const std::string& in_model, const Model& model, const BoundEffect& effect) {
  const std::string prefix = effect.name + ".";
  if (!in_model.starts_with(prefix)) return {in_model};
  const std::string bare = in_model.substr(prefix.size());
  const bool of_system = model.find_parameter(bare) >= 0;
  if (of_system || comes_after_another_with(bare, model, effect)) return {in_model};
  return {in_model, bare};
}

ModelRequest request_without(const ModelRequest& request, const Model& model, const BoundEffect& effect) {
  ModelRequest out = request;
  std::erase_if(out.effects, [&](const EffectRequest& e) { return e.name == effect.name; });
  for (std::size_t c = 0; c < effect.coefficients.size(); ++c) {
    const BoundCoefficient& coefficient = effect.coefficients[c];
    if (effect.effect->spec().coefficients[c].shared) continue;
    if (coefficient.curve >= 0) {
      for (const std::string& name : names_in_request(model.curves[coefficient.curve].name, model, effect)) out.curves.erase(name);
    }
    if (coefficient.parameter >= 0) {
      for (const std::string& name : names_in_request(model.parameters[coefficient.parameter].name, model, effect))
        out.parameters.erase(name);
    }
  }
  const auto of_effect = [&](const auto& named) { return named.first.starts_with(effect.name + "."); };  // as its line in a study has them
  std::erase_if(out.parameters, of_effect);
  std::erase_if(out.curves, of_effect);
  return out;
}

void copy_parameter(const Parameter& from, Parameter& to) {
  to.value = from.value;
  to.free = from.free;
  to.lower = from.lower;
  to.upper = from.upper;
}

/// Values of what both models have. A coefficient's name may have changed: another effect of the same kind is gone.
void copy_values(const Model& from, Model& to) {
  for (Parameter& p : to.parameters) {
    const int same = from.find_parameter(p.name);
    if (same >= 0) copy_parameter(from.parameters[same], p);
  }
  for (const BoundEffect& effect : to.effects) {
    const BoundEffect* before = effect_called(from, effect.name);
    if (before == nullptr) continue;
    const std::vector<int> there = own_parameters(from, *before), here = own_parameters(to, effect);
    for (std::size_t i = 0; i < std::min(there.size(), here.size()); ++i) copy_parameter(from.parameters[there[i]], to.parameters[here[i]]);
  }
}

}  // namespace

double chance_of(double drop, int parameters, double families) {
  return sidak(chi_square_tail(std::max(drop, 0.0), std::max(parameters, 1)), std::max(families, 1.0));
}

bool may_be_chance(double drop, int parameters, double families) {
  constexpr double by_chance = 0.01;
  return chance_of(drop, parameters, families) > by_chance;
}

bool may_leave(const FilterEstimate& estimate, const std::string& name, double sigmas) {
  const BoundEffect* effect = effect_called(estimate.model, name);
  if (effect == nullptr) return false;
  bool any = false;
  for (const int index : own_parameters(estimate.model, *effect)) {
    const Parameter& p = estimate.model.parameters[index];
    if (p.kind != CoefficientKind::strength || !p.free) continue;
    const std::optional<double> sigma = standard_error_of(estimate.model, estimate.covariance, index);
    if (!sigma || std::abs(p.value) > sigmas * *sigma) return false;
    any = true;
  }
  return any;
}

std::optional<Without> without_effect(const FittedStudy& fitted, const std::string& name, int threads) {
  const FilterEstimate& estimate = fitted.estimate;
  const BoundEffect* effect = effect_called(estimate.model, name);
  if (effect == nullptr) return std::nullopt;
  try {
    Without out;
    out.request = request_without(fitted.request, estimate.model, *effect);
    Model start = assemble(out.request, fitted.registry);
    copy_values(estimate.model, start);
    out.estimate = estimate_filter(start, with_weights_of(estimate, start, curve_penalties(start)), fitted.experiments,
                                   options_like(estimate, threads));
    if (!out.estimate.converged || out.estimate.out_of_time) return std::nullopt;
    out.drop = likelihood_drop(estimate, out.estimate);
    for (const int index : own_parameters(estimate.model, *effect)) out.parameters += estimate.model.parameters[index].free ? 1 : 0;
    out.p_value = chi_square_tail(std::max(out.drop, 0.0), std::max(out.parameters, 1));
    return out;
  } catch (const DoesNotSuit&) {
    return std::nullopt;  // another effect needs it
  } catch (const RunError&) {
    return std::nullopt;
  } catch (const TimeLimitReached&) {
    return std::nullopt;
  }
}

std::optional<FreedWidth> freed_width(const FilterEstimate& estimate, const std::vector<Signals>& experiments, const std::string& name,
                                      int threads) {
  const BoundEffect* effect = effect_called(estimate.model, name);
  if (effect == nullptr) return std::nullopt;
  const OperatingRange visited(estimate);
  const auto& coefficients = effect->effect->spec().coefficients;
  for (std::size_t c = 0; c < coefficients.size(); ++c) {
    const int at = effect->coefficients[c].parameter;
    if (!coefficients[c].scan.smooths || at < 0 || estimate.model.parameters[at].free) continue;
    Model start = estimate.model;
    Parameter& width = start.parameters[at];
    width.free = true;
    width.lower = visited.lower_bound(*effect, c);
    width.value = std::clamp(width.value, 1.01 * width.lower, width.upper);
    try {
      const FilterEstimate there =
          estimate_filter(start, with_weights_of(estimate, start, curve_penalties(start)), experiments, options_like(estimate, threads));
      const double value = there.model.parameters[at].value;
      constexpr double at_bound = 1.05;
      if (!there.converged || there.out_of_time || value < at_bound * width.lower) continue;
      return FreedWidth{coefficients[c].name, value, 2.0 * (there.objective - estimate.objective)};
    } catch (const RunError&) {
      continue;
    } catch (const TimeLimitReached&) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace misfit
