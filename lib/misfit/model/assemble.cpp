#include <algorithm>
#include <cmath>

#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/model/assembler.h"
#include "misfit/model/role_units.h"

namespace misfit {
namespace {

std::string with_unit(double value, const std::string& unit) { return format_value(value) + (unit == "-" ? "" : " " + plain_si(unit)); }

double typical_size(const ConstantSpec& constant, double value) {
  if (constant.scale > 0.0) return constant.scale;
  if (value != 0.0) return std::abs(value);
  return constant.prior_sigma > 0.0 ? constant.prior_sigma : 1.0;
}

}  // namespace

Assembler::Assembler(const ModelRequest& request, const Registry& registry) : request_(request), registry_(registry) {
  const SystemType& type = registry.system(request.system, request.system_where);
  for (const auto& [flag, value] : request.options.flags) {
    if (std::find(type.flags.begin(), type.flags.end(), flag) == type.flags.end()) {
      throw InputError(request.system_where,
                       "system '" + shown(request.system) + "' has no option '" + shown(flag) + "'" + suggest(flag, type.flags));
    }
  }
  for (const auto& [number, value] : request.options.numbers) {
    throw InputError(request.system_where,
                     "system '" + shown(request.system) + "' has no option '" + shown(number) + "'" + suggest(number, type.flags));
  }
  model_.system = type.make(request.options);
}

Model Assembler::run() {
  add_states();
  add_noise();
  add_constants();
  name_coefficients();
  for (std::size_t i = 0; i < request_.effects.size(); ++i) bind(i);
  share_coefficients();
  check_everything_used();
  check_sizes();
  return std::move(model_);
}

std::map<std::string, std::string> Assembler::curves_without_knots() {
  std::map<std::string, std::string> open;
  name_coefficients();
  for (std::size_t i = 0; i < request_.effects.size(); ++i) {
    const auto& spec = effect(i).spec();
    for (std::size_t c = 0; c < spec.coefficients.size(); ++c) {
      if (spec.coefficients[c].shared) continue;
      const auto curve = curve_request(names_[i][c], spec.coefficients[c], request_.effects[i]);
      if (curve && curve->knots.empty()) open[curve_in_request(names_[i][c])] = curve->of;
    }
  }
  return open;
}

std::map<std::string, std::string> Assembler::parameter_units() {
  std::map<std::string, std::string> units;
  for (const auto& constant : system().constants) units[constant.name] = constant.unit;
  name_coefficients();
  for (std::size_t i = 0; i < request_.effects.size(); ++i) {
    const auto& spec = effect(i).spec();
    const auto roles = role_units(request_.effects[i], spec);
    for (std::size_t c = 0; c < spec.coefficients.size(); ++c) {
      if (!spec.coefficients[c].shared) units[names_[i][c]] = bind_unit(spec.coefficients[c].unit, roles);
    }
  }
  for (const auto& [name, other] : other_names_) {
    if (units.contains(name)) units.emplace(other, units.at(name));
  }
  return units;
}

std::map<std::string, std::string> Assembler::parameter_names() {
  std::map<std::string, std::string> names;
  for (const auto& [name, unit] : parameter_units()) names[name] = name;
  for (const auto& [name, other] : other_names_) names[other] = name;
  return names;
}

void Assembler::add_states() {
  model_.state_specs = system().states;
  std::vector<std::string> names;
  for (const auto& state : system().states) names.push_back(state.name);
  for (const auto& [name, request] : request_.initial) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      throw InputError(request.where, "[initial]: system '" + system().key + "' has no state '" + shown(name) + "'" + suggest(name, names));
    StateSpec& state = model_.state_specs[found - names.begin()];
    if (request.value) state.start = *request.value;
    if (request.initial) state.initial = *request.initial;
    if (state.start < state.lower || state.start > state.upper) {
      throw InputError(request.where, "[initial] " + name + " = " + with_unit(state.start, state.unit) + " is outside its range, " +
                                          with_unit(state.lower, state.unit) + " to " + with_unit(state.upper, state.unit));
    }
    if (state.initial == Initial::fixed && !std::isfinite(state.start))
      throw InputError(request.where, "[initial] " + name + " is fixed and needs a value");
  }
}

void Assembler::add_noise() {
  model_.known_noise.assign(system().outputs.size(), {});
  model_.force_time = request_.force_time;
  model_.force_strength = request_.force_strength;
  std::vector<std::string> names;
  for (const auto& output : system().outputs) names.push_back(output.name);
  for (const auto& [name, request] : request_.noise) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      throw InputError(request.where, "[noise]: system '" + system().key + "' has no output '" + shown(name) + "'" + suggest(name, names));
    model_.known_noise[found - names.begin()] = {request.sigma, request.fixed, request.frequency};
  }
}

void Assembler::add_constants() {
  for (const auto& constant : system().constants) {
    const auto given = request_.constants.find(constant.name);
    const auto asked = request_.parameters.find(constant.name);
    const bool valued = asked != request_.parameters.end() && asked->second.value;
    if (given == request_.constants.end() && constant.required && !valued) {
      throw InputError(request_.system_where,
                       "[geometry] " + constant.name + " is missing: " + constant.doc + " [" + plain_si(constant.unit) + "]");
    }
    Parameter p{constant.name, constant.unit, constant.doc};
    p.value = given == request_.constants.end() ? constant.value : given->second;
    p.lower = constant.lower;
    p.upper = constant.upper;
    const auto where = request_.constants_where.find(constant.name);
    if (!valued) check_bounds(p, where == request_.constants_where.end() ? Source{} : where->second);
    p.free = constant.free;
    if (constant.prior_sigma > 0.0) p.prior_sigma = constant.prior_sigma;
    if (constant.strength) p.kind = CoefficientKind::strength;
    const bool known = given != request_.constants.end() || !constant.required;
    if (known) p.prior_mean = p.value;
    if (valued) p.value = *asked->second.value;
    if (!known) p.prior_mean = p.value;
    p.scale = typical_size(constant, p.value);
    const auto sigma = request_.constant_sigmas.find(constant.name);
    if (sigma != request_.constant_sigmas.end()) p.prior_sigma = sigma->second;
    apply_request(p);
    model_.parameters.push_back(p);
  }
}

void Assembler::check_bounds(const Parameter& p, const Source& where) {
  if (p.value >= p.lower && p.value <= p.upper) return;
  throw InputError(where, p.name + " = " + with_unit(p.value, p.unit) + " is outside its bounds, " + with_unit(p.lower, p.unit) + " to " +
                              with_unit(p.upper, p.unit));
}

const ParameterRequest* Assembler::parameter_request(const std::string& name) const {
  auto found = request_.parameters.find(name);
  const auto other = other_names_.find(name);
  if (found == request_.parameters.end() && other != other_names_.end()) found = request_.parameters.find(other->second);
  return found == request_.parameters.end() ? nullptr : &found->second;
}

void Assembler::apply_request(Parameter& p) {
  const ParameterRequest* asked = parameter_request(p.name);
  if (asked == nullptr) return;
  used_parameters_.insert(asked);
  const ParameterRequest& r = *asked;
  if (r.lower) p.lower = *r.lower;
  if (r.upper) p.upper = *r.upper;
  if (r.value) p.value = *r.value;
  if (r.value && !std::isfinite(p.lower) && !std::isfinite(p.upper)) p.scale = std::max(p.scale, std::abs(p.value));
  if (r.free) p.free = *r.free;
  if (r.sigma) {  // else the value is a start: who gave the sigma gave the mean
    p.prior_sigma = r.sigma;
    p.prior_mean = p.value;
  }
  if (!(p.lower < p.upper))
    throw InputError(r.where,
                     "bounds of " + p.name + " must increase: [" + with_unit(p.lower, p.unit) + ", " + with_unit(p.upper, p.unit) + "]");
  check_bounds(p, r.where);
}

void Assembler::check_everything_used() const {
  std::vector<std::string> names, curves;
  for (const auto& p : model_.parameters) {
    if (p.curve < 0) names.push_back(p.name);
  }
  for (const auto& list : names_) curves.insert(curves.end(), list.begin(), list.end());
  for (const auto& curve : model_.curves) names.push_back(curve.name);
  for (const auto& [name, request] : request_.parameters) {
    if (!used_parameters_.contains(&request))
      throw InputError(request.where, "[parameters]: the model has no parameter '" + shown(name) + "'" + suggest(name, names));
  }
  for (const auto& [name, request] : request_.curves) {
    if (used_curves_.contains(name)) continue;
    if (index_of(system().constants, name) >= 0) {
      throw InputError(request.where, "[curves]: '" + shown(name) +
                                          "' is a parameter of the system; only coefficients of effects can be curves" +
                                          (curves.empty() ? ", and the model has none" : ": " + join_words(curves)));
    }
    throw InputError(request.where, "[curves]: the model has no coefficient '" + shown(name) + "'" + suggest(name, curves));
  }
}

void Assembler::check_sizes() const {
  const auto limit = [&](std::size_t have, std::size_t most, const char* what) {
    if (have > most)
      throw InputError(request_.system_where,
                       "the model has " + std::to_string(have) + " " + what + "; at most " + std::to_string(most) + " are possible");
  };
  limit(model_.states(), kMaxStates, "states");
  limit(system().quantities.size() + system().outputs.size(), kMaxQuantities, "quantities");
  limit(system().dynamic_ports.size() + model_.own_states.size(), kMaxPorts, "dynamic ports and own states");
  limit(system().quantity_ports.size(), kMaxPorts, "quantity ports");
  limit(system().inputs.size(), kMaxInputs, "inputs");
  limit(system().outputs.size(), kMaxOutputs, "outputs");
  limit(system().constants.size(), kMaxConstants, "constants");
  limit(model_.free_parameters().size(), kMaxColumns, "free parameters");
}

Model assemble(const ModelRequest& request, const Registry& registry) { return Assembler(request, registry).run(); }

std::map<std::string, std::string> curves_without_knots(const ModelRequest& request, const Registry& registry) {
  return Assembler(request, registry).curves_without_knots();
}

std::map<std::string, std::string> parameter_units(const ModelRequest& request, const Registry& registry) {
  return Assembler(request, registry).parameter_units();
}

std::map<std::string, std::string> parameter_names(const ModelRequest& request, const Registry& registry) {
  return Assembler(request, registry).parameter_names();
}

}  // namespace misfit
