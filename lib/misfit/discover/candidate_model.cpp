#include "misfit/discover/candidate_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/discover/bindings.h"
#include "misfit/discover/operating_range.h"
#include "misfit/math/statistics.h"
#include "misfit/model/does_not_suit.h"
#include "misfit/model/memory.h"

namespace misfit {
namespace {

bool driven_by_noise(const Effect& effect) {
  if (effect.spec().states.empty()) return false;
  for (const Example& example : effect.examples()) {
    std::vector<double> noise(effect.spec().states.size(), 0.0);
    effect.diffusion({example.quantities.data(), example.coefficients.data(), example.states.data(), example.constants.data(), example.t},
                     noise.data());
    if (std::any_of(noise.begin(), noise.end(), [](double v) { return v > 0.0; })) return true;
  }
  return false;
}

/// Does any of its examples change with the time of the recording?
bool reads_time(const Effect& effect) {
  const std::size_t size = effect.spec().ports.size() + effect.spec().states.size();
  for (const Example& example : effect.examples()) {
    constexpr double later_time = 0.37;
    std::vector<double> now(size, 0.0), then(size, 0.0);
    const auto at = [&](double t, std::vector<double>& out) {
      effect.evaluate({example.quantities.data(), example.coefficients.data(), example.states.data(), example.constants.data(), t},
                      out.data());
    };
    at(example.t, now);
    at(example.t + later_time, then);
    if (now != then) return true;
  }
  return false;
}

bool in_model(const ModelRequest& request, const std::string& key) {
  return std::any_of(request.effects.begin(), request.effects.end(), [&](const EffectRequest& e) { return e.kind == key; });
}

/// The same effect at the same place.
bool same_place(const BoundEffect& a, const BoundEffect& b) {
  return a.effect == b.effect && a.kind == b.kind && a.ports == b.ports && a.quantities == b.quantities;
}

bool specialised(const Registry& registry, const std::vector<std::string>& suiting, const std::string& key) {
  return std::any_of(suiting.begin(), suiting.end(),
                     [&](const std::string& other) { return registry.effect(other).spec().specialises == key; });
}

bool has_strength(const EffectSpec& spec) {
  return std::any_of(spec.coefficients.begin(), spec.coefficients.end(),
                     [](const CoefficientSpec& c) { return c.kind == CoefficientKind::strength && !c.shared; });
}

/// The kind, or kind_2, … where the model has one already.
std::string name_of_another(const ModelRequest& request, const EffectSpec& spec) {
  std::string name = spec.key;
  const auto taken = [&] {
    return std::any_of(request.effects.begin(), request.effects.end(), [&](const EffectRequest& e) { return e.name == name; });
  };
  for (int number = 2; taken(); ++number) name = spec.key + "_" + std::to_string(number);
  return name;
}

/// The request with the effect; coefficients that default to curves are numbers, as the formula reads them (C/sin where one enters over a
/// sine).
ModelRequest with_effect(const ModelRequest& request, const Effect& effect, const Roles& roles, const SystemSpec& system) {
  ModelRequest out = request;
  out.effects.push_back({name_of_another(request, effect.spec()), effect.spec().key, roles, {}});
  for (const auto& c : effect.spec().coefficients) {
    if (c.shared || c.curve_of[0] == '\0') continue;
    ParameterRequest number;
    number.value = 0.0;
    number.free = true;
    const auto renamed = system.coefficient_names.find(c.name);
    out.parameters[out.effects.back().name + "." + (renamed == system.coefficient_names.end() ? c.name : renamed->second)] = number;
  }
  return out;
}

/// Prior of a strength: the calibration's own sigma where it freed or tested the parameter, else the effect's.
void add_prior(const CoefficientSpec& c, const Calibration* calibration, Eigen::Index i, CandidateModel& out) {
  const std::string name = c.calibrated_as;
  double sigma = c.prior_sigma, mean = 0.0;
  if (calibration != nullptr && !name.empty()) {
    const double freed = calibration->sigma(name);
    if (freed > 0.0) sigma = freed;
    for (const auto& test : calibration->tests) {
      for (std::size_t k = 0; k < test.parameters.size() && !(freed > 0.0); ++k) {
        if (test.parameters[k] != name || test.selected || !(test.sigmas[k] > 0.0)) continue;
        sigma = test.sigmas[k];
        mean = test.values[k] - calibration->value(name);  // what the sweep would have it be
      }
    }
  }
  if (!(sigma > 0.0)) return;
  out.has_priors = true;
  out.priors.precision[i] = 1.0 / (sigma * sigma);
  out.priors.mean[i] = mean;
}

/// As far off as discovery looks for a strength: CoefficientSpec::lower_as_candidate, steps_as_candidate.
void bound_as_candidate(const CoefficientSpec& c, double step, Parameter& p) {
  p.lower = std::max(p.lower, c.lower_as_candidate);
  if (c.steps_as_candidate <= 0.0 || step <= 0.0) return;
  p.lower = std::max(p.lower, -c.steps_as_candidate * step);
  p.upper = std::min(p.upper, c.steps_as_candidate * step);
}

/// What ScanSpec::over says of something that recurs: "displacement", or "speed dt" of its integral.
CandidateModel::Way way_of(const BoundEffect& bound, const ScanSpec& scan) {
  constexpr std::string_view integral = " dt";
  std::string_view role = scan.over;
  const bool integrated = role.ends_with(integral);
  if (integrated) role.remove_suffix(integral.size());
  const auto& quantities = bound.effect->spec().quantities;
  const auto found = std::find_if(quantities.begin(), quantities.end(), [&](const Role& r) { return role == r.name; });
  return {bound.quantities[found - quantities.begin()], integrated};
}

void fill(const Effect& effect, const Calibration* calibration, const OperatingRange& operating_range, CandidateModel& out) {
  const BoundEffect& bound = out.model.effects.back();
  const auto& coefficients = effect.spec().coefficients;
  std::vector<std::vector<double>> axes;
  std::vector<const CoefficientSpec*> strength_specs;
  for (std::size_t c = 0; c < coefficients.size(); ++c) {
    const int parameter = bound.coefficients[c].parameter;
    if (coefficients[c].shared || parameter < 0) continue;
    Parameter& p = out.model.parameters[parameter];
    if (coefficients[c].kind == CoefficientKind::strength) {
      p.free = true;
      p.value = 0.0;
      out.strengths.push_back(parameter);
      bound_as_candidate(coefficients[c], operating_range.step(), p);
      out.one_sided.push_back(p.lower >= 0.0);
      strength_specs.push_back(&coefficients[c]);
    } else if (coefficients[c].scan.count > 0) {
      out.shapes.push_back(parameter);
      p.lower = operating_range.lower_bound(bound, c);
      axes.push_back(operating_range.grid(bound, c));
    } else if (coefficients[c].scan.is_frequency()) {
      out.frequency = parameter;
      out.frequency_from = coefficients[c].scan.from;
      out.frequency_to = coefficients[c].scan.to;
      if (!coefficients[c].scan.is_in_time()) out.recurs_along = way_of(bound, coefficients[c].scan);
    }
  }
  out.cells = {{}};
  for (const auto& axis : axes) {
    std::vector<std::vector<double>> grown;
    for (const auto& cell : out.cells) {
      for (double value : axis) {
        grown.push_back(cell);
        grown.back().push_back(value);
      }
    }
    out.cells = std::move(grown);
  }
  const Eigen::Index n = out.strengths.size();
  out.priors.precision = out.priors.mean = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) add_prior(*strength_specs[i], calibration, i, out);
  for (std::size_t p = 0; p < bound.ports.size(); ++p) {
    if (bound.ports[p] < 0) continue;
    if (bound.kind == PortKind::dynamic) out.ports.push_back(bound.ports[p]);
  }
  for (int q : bound.quantities) {
    if (q >= 0) out.quantities.push_back(q);
  }
  if (reads_time(*bound.effect)) out.quantities.push_back(kTime);
  out.lags = has_linear_memory(*bound.effect) || reads_the_past(effect.spec());
}

/// A sensor effect changes what the states mean, and with them the Kalman gains: with gains fixed the information is overestimated (sigma
/// of a camera roll nine times too small, of lens distortion three times). Hence differences of whole filter runs, gains included.
Eigen::MatrixXd columns_of_whole_runs(const FilterEstimate& estimate, const CandidateModel& candidate_model, const FilterModel& forced) {
  FilterRunner runner(forced, false);
  std::vector<double> values = forced.model.values();
  Eigen::MatrixXd out(counted_rows(estimate), candidate_model.strengths.size());
  std::array<FilterTrace, 2> sides;
  std::vector<FilterData> data;
  for (const FilterData& known : estimate.data) data.push_back(filter_data_like(forced, known));
  for (std::size_t c = 0; c < candidate_model.strengths.size(); ++c) {
    const std::size_t parameter = candidate_model.strengths[c];
    constexpr double share_of_scale = 1e-2;
    const double h = share_of_scale * forced.model.parameters[parameter].scale;
    Eigen::Index row = 0;
    for (std::size_t e = 0; e < estimate.data.size(); ++e) {
      for (std::size_t side = 0; side < 2; ++side) {
        values[parameter] = side == 0 ? -h : h;
        runner.set_parameters(values);
        if (!runner.run(data[e], estimate.noise, sides[side], {.held_out = false})) return {};
      }
      for (std::size_t at : estimate.jacobians[e].index)
        out(row++, c) = (sides[0].departure(at) - sides[1].departure(at)) / (2.0 * h * std::sqrt(estimate.traces[e].S[at]));
    }
    values[parameter] = 0.0;
  }
  return out;
}

/// An input that the model did without so far may have no values (Signals::inputs). InputError: it needs such a one.
void require_inputs(const FilterEstimate& estimate, const Model& model) {
  const std::vector<std::string> needed = model.needed_inputs();
  for (const FilterData& data : estimate.data) {
    for (const Signal& input : data.signals->inputs) {
      if (!input.values.empty() || std::find(needed.begin(), needed.end(), input.name) == needed.end()) continue;
      throw InputError("input '" + shown(input.name) +
                       "' is not recorded, or with gaps: it can be tried with a column of it in every experiment");
    }
  }
}

/// The model with the effect there, all fixed at the estimate; nullopt where the effect does not suit. InputError: it cannot be tried.
std::optional<CandidateModel> candidate_model_at(const FilterEstimate& estimate, const ModelRequest& request, const Registry& registry,
                                                 const EffectPlace& place) {
  const auto& [key, roles] = place;
  const Effect& effect = registry.effect(key);
  CandidateModel out;
  out.effect = effect.spec().key;
  out.roles = roles;
  out.request = with_effect(request, effect, roles, estimate.model.system->spec());
  try {
    out.model = assemble(out.request, registry);
  } catch (const DoesNotSuit&) {
    return std::nullopt;
  }
  require_inputs(estimate, out.model);
  const bool on_sensor = out.model.effects.back().kind == PortKind::sensor;
  out.family = on_sensor ? CandidateFamily::sensor : is_generic(effect.spec()) ? CandidateFamily::generic : CandidateFamily::physics;
  for (auto& p : out.model.parameters) p.free = false;
  for (std::size_t i = 0; i < estimate.model.parameters.size(); ++i)  // the effect's own follow behind
    out.model.parameters[i].value = estimate.model.parameters[i].value;
  out.port_names = names_of_ports(out.model.system->spec(), out.model.effects.back());
  return out;
}

/// In the model, or among those listed: a default role may be the very place that the system suggests.
bool already_listed(const CandidateModel& candidate_model, const std::vector<CandidateModel>& listed) {
  const auto& effects = candidate_model.model.effects;
  return std::any_of(effects.begin(), effects.end() - 1, [&](const BoundEffect& e) { return same_place(e, effects.back()); }) ||
         std::any_of(listed.begin(), listed.end(),
                     [&](const CandidateModel& s) { return same_place(s.model.effects.back(), effects.back()); });
}

/// A force or an error of its own that is off where its strengths are 0.
bool can_be_candidate(const Effect& effect) {
  return has_strength(effect.spec()) && !effect.spec().has_unknown_form() && !driven_by_noise(effect);
}

/// An input that stays as it is from most samples to the next, in every recording.
bool is_held(const FilterEstimate& estimate, const std::string& input) {
  constexpr double most = 0.5;
  return std::all_of(estimate.data.begin(), estimate.data.end(), [&](const FilterData& data) {
    const auto& inputs = data.signals->inputs;
    const auto found = std::find_if(inputs.begin(), inputs.end(), [&](const Signal& s) { return s.name == input; });
    return found != inputs.end() && repeat_share(found->values) > most;
  });
}

/// Of an effect that shows an input in an output at once: a controller that reads that output's noise sets its input by it at the very
/// sample, so that in closed loop there is no telling the one from the other (Ljung, System Identification (1999), 13.4: the loop needs a
/// delay). Empty: it can be looked for.
std::string why_in_a_loop(const CandidateModel& candidate, const FilterEstimate& estimate) {
  const BoundEffect& effect = candidate.model.effects.back();
  const SystemSpec& system = candidate.model.system->spec();
  if (effect.kind != PortKind::sensor) return "";
  for (const int quantity : effect.quantities) {
    if (quantity < 0 || quantity >= std::ssize(system.quantities)) continue;
    const int input = candidate.model.input_of_quantity(quantity);
    if (input >= 0 && !is_held(estimate, system.inputs[input].name))
      return "input " + system.inputs[input].name +
             " moves at most samples: a controller that reads the noise of an output makes it look as if it showed there at once";
  }
  return "";
}

/// The same reason is given once, for the first of the effect's places.
void add_not_tried(NotTried added, std::vector<NotTried>& list) {
  const bool known = std::any_of(list.begin(), list.end(),
                                 [&](const NotTried& n) { return n.place.effect == added.place.effect && n.reason == added.reason; });
  if (!known) list.push_back(std::move(added));
}

}  // namespace

std::vector<std::string> names_of_ports(const SystemSpec& system, const BoundEffect& effect) {
  std::vector<std::string> out;
  for (int p : effect.ports) {
    if (p < 0) continue;
    const std::size_t i = p;
    if (effect.kind == PortKind::dynamic) out.push_back(system.dynamic_ports[i].name);
    if (effect.kind == PortKind::quantity) out.push_back(system.quantity_ports[i].name);
    const std::size_t outputs = system.outputs.size();
    if (effect.kind != PortKind::sensor) continue;
    out.push_back(i < outputs    ? system.outputs[i].name
                  : i == outputs ? std::string(all_sample_times)
                                 : "time of " + system.outputs[i - outputs - 1].name);
  }
  return out;
}

CandidateList list_candidates(const FilterEstimate& estimate, const ModelRequest& request, const Registry& registry,
                              const Calibration* calibration) {
  CandidateList out;
  std::vector<std::string> suiting;  // candidates and what the model has
  for (const EffectRequest& effect : request.effects) suiting.push_back(effect.kind);
  const OperatingRange operating_range(estimate);
  for (const std::string& key : registry.effect_keys()) {
    const Effect& effect = registry.effect(key);
    if (!can_be_candidate(effect)) continue;
    for (const Roles& roles : enumerate_bindings(effect.spec(), estimate.model.system->spec())) {
      if (roles.empty() && in_model(request, key)) continue;
      try {
        std::optional<CandidateModel> candidate_model = candidate_model_at(estimate, request, registry, {key, roles});
        if (!candidate_model || already_listed(*candidate_model, out.models)) continue;
        if (const std::string why = why_in_a_loop(*candidate_model, estimate); !why.empty()) {
          add_not_tried({{key, roles}, why}, out.not_tried);
          continue;
        }
        fill(effect, calibration, operating_range, *candidate_model);
        if (std::find(suiting.begin(), suiting.end(), key) == suiting.end()) suiting.push_back(key);
        out.models.push_back(std::move(*candidate_model));
      } catch (const InputError& error) {
        add_not_tried({{key, roles}, error.what()}, out.not_tried);
      }
    }
  }
  std::erase_if(out.models, [&](const CandidateModel& s) { return specialised(registry, suiting, s.effect); });
  std::erase_if(out.not_tried, [&](const NotTried& n) { return specialised(registry, suiting, n.place.effect); });
  return out;
}

std::vector<CandidateModel> candidate_models(const FilterEstimate& estimate, const ModelRequest& request, const Registry& registry,
                                             const Calibration* calibration) {
  return list_candidates(estimate, request, registry, calibration).models;
}

std::vector<bool> twins_among(const std::vector<CandidateModel>& models, const std::vector<int>& sought_at) {
  std::vector<bool> out;
  for (const CandidateModel& model : models) {
    const BoundEffect& here = model.model.effects.back();
    BoundEffect there = here;
    for (int& port : there.ports) port = port < 0 || here.kind != PortKind::dynamic ? port : sought_at[port];
    const auto is_there = [&](const CandidateModel& m) { return same_place(m.model.effects.back(), there); };
    out.push_back(there.ports != here.ports && std::any_of(models.begin(), models.end(), is_there));
  }
  return out;
}

void leave_out(const std::vector<bool>& which, std::vector<CandidateModel>& models) {
  std::vector<CandidateModel> kept;
  for (std::size_t k = 0; k < models.size(); ++k) {
    if (!which[k]) kept.push_back(std::move(models[k]));
  }
  models = std::move(kept);
}

std::optional<CandidateModel> candidate_model_of(const FittedStudy& fitted, const EffectRequest& effect, const Calibration* calibration) {
  const Effect& asked = fitted.registry.effect(effect.kind);
  if (!can_be_candidate(asked)) return std::nullopt;
  try {
    std::optional<CandidateModel> out = candidate_model_at(fitted.estimate, fitted.request, fitted.registry, {effect.kind, effect.roles});
    if (out) fill(asked, calibration, OperatingRange(fitted.estimate), *out);
    return out;
  } catch (const InputError&) {  // what a study says of it has been assembled: only as a number, as here, it is refused
    return std::nullopt;
  }
}

Eigen::MatrixXd columns_with_fixed_gains(const FilterEstimate& estimate, const FilterModel& forced) {
  FilterRunner runner(forced, true);
  runner.set_parameters(forced.model.values());
  Eigen::MatrixXd out(counted_rows(estimate), std::ssize(forced.model.free_parameters()));
  Eigen::Index at = 0;
  FilterTrace trace;
  FilterJacobian jacobian;
  for (const auto& known : estimate.data) {
    const FilterData data = filter_data_like(forced, known);
    if (!runner.run(data, estimate.noise, trace, {.jacobian = &jacobian, .held_out = false})) return {};
    out.middleRows(at, jacobian.r.size()) = jacobian.J;
    at += jacobian.r.size();
  }
  return out;
}

Eigen::MatrixXd sensitivity_columns(const FilterEstimate& estimate, const CandidateModel& candidate_model,
                                    const std::vector<double>& cell) {
  FilterModel forced = with_random_force(candidate_model.model);
  forced.model.parameters[forced.time_parameter].value = estimate.noise.force_time;
  for (std::size_t i = 0; i < candidate_model.shapes.size(); ++i) forced.model.parameters[candidate_model.shapes[i]].value = cell[i];
  if (cell.size() > candidate_model.shapes.size()) forced.model.parameters[candidate_model.frequency].value = cell.back();
  return candidate_model.family == CandidateFamily::sensor ? columns_of_whole_runs(estimate, candidate_model, forced)
                                                           : columns_with_fixed_gains(estimate, forced);
}

}  // namespace misfit
