// One effect put in its place: ports, quantities, constants, coefficients.

#include "misfit/core/lists.h"
#include "misfit/core/shown.h"
#include "misfit/core/units.h"
#include "misfit/model/assembler.h"
#include "misfit/model/does_not_suit.h"
#include "misfit/model/role_units.h"

namespace misfit {

void Assembler::bind(std::size_t i) {
  const EffectRequest& request = request_.effects[i];
  const EffectSpec& spec = effect(i).spec();
  for (std::size_t j = 0; j < i; ++j) {
    if (request_.effects[j].name == request.name) throw InputError(request.where, "effect '" + shown(request.name) + "' is named twice");
  }
  if (std::find(system().includes.begin(), system().includes.end(), spec.key) != system().includes.end()) {
    throw DoesNotSuit(request.where, "effect '" + shown(request.name) + "': the equations of system '" + system().key + "' have '" +
                                         spec.key + "' by themselves, it would count twice");
  }
  BoundEffect bound;
  bound.effect = &effect(i);
  bound.name = request.name;
  check_roles(request, spec);
  role_units_ = role_units(request, spec);
  bind_ports(request, spec, bound);
  for (const auto& role : spec.quantities) bound.quantities.push_back(bind_quantity(request, role, bound.kind));
  for (const auto& name : spec.constants) bound.constants.push_back(bind_constant(request, name));
  bound.first_state = int_size(model_.own_states);
  for (const auto& state : spec.states) {
    model_.own_states.push_back(state);
    model_.own_state_names.push_back(request.name + "." + state.name);
    model_.own_state_units.push_back(bind_unit(state.unit, role_units_));
  }
  for (std::size_t c = 0; c < spec.coefficients.size(); ++c)
    bound.coefficients.push_back(bind_coefficient(names_[i][c], spec.coefficients[c], request, bound.kind));
  model_.effects.push_back(std::move(bound));
}

void Assembler::check_roles(const EffectRequest& request, const EffectSpec& spec) {
  std::vector<std::string> valid;
  for (const auto& role : spec.quantities) valid.emplace_back(role.name);
  for (const auto& role : spec.ports) valid.emplace_back(role.name);
  for (const auto& [role, target] : request.roles) {
    if (std::find(valid.begin(), valid.end(), role) == valid.end()) {
      throw InputError(request.where, "effect '" + shown(request.name) + "' (" + spec.key + ") has no role '" + shown(role) + "'" +
                                          (role == "inertia" ? ": what its force moves is known from the equations, leave the role out"
                                                             : suggest(role, valid)));
    }
  }
}

bool Assembler::is_left_out(const EffectRequest& request, const Role& role) {
  return role.completes[0] != '\0' && request.roles.contains(role.completes) && !request.roles.contains(role.name);
}

void Assembler::bind_ports(const EffectRequest& request, const EffectSpec& spec, BoundEffect& bound) const {
  bool first = true;
  for (const auto& role : spec.ports) {
    if (is_left_out(request, role)) {
      bound.ports.push_back(-1);
      continue;
    }
    const std::string target = target_of(request, role, [&](const std::string& name) { return find_port(name).has_value(); });
    const auto place = find_port(role, target);
    if (!place) {
      if (role.optional && !request.roles.contains(role.name)) {
        bound.ports.push_back(-1);
        continue;
      }
      throw DoesNotSuit(request.where, "effect '" + shown(request.name) + "': system '" + system().key + "' has no port '" + shown(target) +
                                           "'" + suggest(target, port_names()));
    }
    check_unit(request, role, "port '" + shown(target) + "'", place->unit);
    if (!first && place->kind != bound.kind) {
      throw DoesNotSuit(request.where, "effect '" + shown(request.name) + "' cannot add to '" + shown(target) +
                                           "' beside its other ports: they are of different kinds");
    }
    bound.kind = place->kind;
    first = false;
    bound.ports.push_back(place->index);
  }
}

void Assembler::check_unit(const EffectRequest& request, const Role& role, const std::string& what, const std::string& unit) const {
  if (role.unit[0] == '*') return;  // a generic role takes any unit
  const std::string needed = bind_unit(role.unit, role_units_);
  if (!parse_unit(needed).same_dimension(parse_unit(unit))) {
    throw DoesNotSuit(request.where, "effect '" + shown(request.name) + "': role '" + shown(role.name) + "' needs [" + needed + "], " +
                                         what + " has [" + unit + "]");
  }
}

int Assembler::bind_quantity(const EffectRequest& request, const Role& role, PortKind kind) const {
  if (is_left_out(request, role)) return -1;
  const std::string target = target_of(request, role, [&](const std::string& name) { return find_quantity(name) >= 0; });
  int index = find_quantity(role, target);
  if (kind == PortKind::quantity && index >= system().base_quantities && index_of(system().inputs, target) >= 0) {
    if (const int recorded = find_quantity(as_recorded(target)); recorded >= 0) index = recorded;  // what such effects change
  }
  if (index < 0) {
    if (role.optional && !request.roles.contains(role.name)) return -1;
    throw DoesNotSuit(request.where, "effect '" + shown(request.name) + "': system '" + system().key + "' has no quantity '" +
                                         shown(target) + "'" + suggest(target, quantity_names()));
  }
  check_order(request.where, "effect '" + shown(request.name) + "'", target, index, kind);
  check_unit(request, role, "quantity '" + shown(target) + "'", unit_of_quantity(index));
  if (role.late_by[0] != '\0') check_input(request, target);
  return index;
}

void Assembler::check_input(const EffectRequest& request, const std::string& target) const {
  if (model_.input_of_quantity(find_quantity(target)) >= 0) return;
  std::vector<std::string> inputs;
  for (const auto& input : system().inputs) inputs.push_back(input.name);
  throw DoesNotSuit(request.where, "effect '" + shown(request.name) + "' reads the past of an input, '" + shown(target) +
                                       "' is none of system '" + system().key + "'" + suggest(target, inputs));
}

void Assembler::check_order(const Source& where, const std::string& who, const std::string& target, int index, PortKind kind) const {
  if (kind == PortKind::quantity && index >= system().base_quantities) {
    throw DoesNotSuit(where, who + " changes a quantity and so cannot read '" + shown(target) + "', which depends on such changes");
  }
  if (kind != PortKind::sensor && index >= int_size(system().quantities)) {
    throw DoesNotSuit(where, who + " cannot read the predicted output '" + shown(target) + "': only effects on sensors can");
  }
}

int Assembler::bind_constant(const EffectRequest& request, const std::string& name) const {
  if (const int i = index_of(system().constants, name); i >= 0) return i;
  throw DoesNotSuit(request.where,
                    "effect '" + shown(request.name) + "' needs '" + shown(name) + "', which system '" + system().key + "' does not have");
}

BoundCoefficient Assembler::bind_coefficient(const std::string& name, const CoefficientSpec& spec, const EffectRequest& request,
                                             PortKind kind) {
  if (spec.shared) return {};  // see share_coefficients()
  const auto curve = curve_request(name, spec, request);
  if (curve) return {-1, add_curve(name, spec, *curve, request, kind)};
  // In a study a number would be taken for the coefficient; of an effect that no file has (a candidate of discovery) it is C/sin, as read.
  const bool as_read = request.where.file.empty() && is_over_sine(spec, find_quantity(spec.curve_of));
  if (spec.over_sine && !as_read)
    throw InputError(request.where, name + " must be a curve: give [curves] " + name + " = { of = \"QUANTITY\" }");
  Parameter p = as_parameter(name, spec);
  apply_request(p);
  model_.parameters.push_back(p);
  return {int_size(model_.parameters) - 1, -1};
}

Parameter Assembler::as_parameter(const std::string& name, const CoefficientSpec& spec) const {
  Parameter p{name, bind_unit(spec.unit, role_units_), spec.doc};
  p.value = spec.value;
  p.lower = spec.lower;
  p.upper = spec.upper;
  p.scale = spec.scale;
  p.free = !spec.fixed;
  p.kind = spec.kind;
  if (spec.own_sigma > 0.0) {
    p.prior_sigma = spec.own_sigma;
    p.prior_mean = spec.value;
  }
  return p;
}

bool Assembler::is_over_sine(const CoefficientSpec& spec, int quantity) const {
  const bool own = quantity >= 0 && quantity < int_size(system().quantities);
  return spec.over_sine && own && !system().quantities[quantity].carries_sign;
}

int Assembler::add_curve(const std::string& name, const CoefficientSpec& spec, const CurveRequest& request, const EffectRequest& by,
                         PortKind kind) {
  used_curves_.insert(curve_in_request(name));
  if (request.of.empty()) throw InputError(request.where, "curve " + name + ": `of` must name a quantity" + suggest("", quantity_names()));
  Curve curve;
  curve.name = name;
  curve.of = request.of;
  curve.unit = bind_unit(spec.unit, role_units_);
  curve.quantity = find_quantity(request.of);
  if (curve.quantity < 0) {
    throw InputError(request.where, "curve " + name + ": system '" + system().key + "' has no quantity '" + shown(request.of) + "'" +
                                        suggest(request.of, quantity_names()));
  }
  check_order(request.where, "effect '" + shown(by.name) + "'", request.of, curve.quantity, kind);
  curve.of_unit = unit_of_quantity(curve.quantity);
  curve.over_sine = is_over_sine(spec, curve.quantity);
  curve.roughness = request.roughness;
  curve.scale = spec.scale;
  try {
    curve.spline = CubicSpline(request.knots, spec.parity);
  } catch (const InputError& error) {
    throw InputError(request.where, "curve " + name + ": " + error.what());
  }
  curve.first = int_size(model_.parameters);
  add_curve_parameters(curve, spec);
  model_.curves.push_back(std::move(curve));
  return int_size(model_.curves) - 1;
}

void Assembler::add_curve_parameters(const Curve& curve, const CoefficientSpec& spec) {
  Parameter p = as_parameter(curve.name, spec);
  p.free = true;
  apply_request(p);
  p.curve = int_size(model_.curves);
  for (int i = 0; i < curve.spline.size(); ++i) {
    p.name = curve.name + "[" + std::to_string(i) + "]";
    model_.parameters.push_back(p);
  }
}

}  // namespace misfit
