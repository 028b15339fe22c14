#include <algorithm>
#include <limits>
#include <set>

#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/model/model.h"
#include "misfit/model/role_units.h"

namespace misfit {
namespace {

std::string with_unit(double value, const std::string& unit) { return format_value(value) + (unit == "-" ? "" : " " + unit); }

/// Work in progress: the model and what is needed to fill it. Over 300 lines: resolving one effect needs every table of names at once, and
/// each check stands beside the name that it is about.
class Assembler {
 public:
  Assembler(const ModelRequest& request, const Registry& registry) : request_(request), registry_(registry) {
    const SystemType& type = registry.system(request.system, request.system_where);
    for (const auto& [flag, value] : request.options.flags) {
      if (std::find(type.flags.begin(), type.flags.end(), flag) == type.flags.end()) {
        throw InputError(request.system_where, "system '" + request.system + "' has no option '" + flag + "'" + suggest(flag, type.flags));
      }
    }
    for (const auto& [number, value] : request.options.numbers) {
      throw InputError(request.system_where,
                       "system '" + request.system + "' has no option '" + number + "'" + suggest(number, type.flags));
    }
    model_.system = type.make(request.options);
  }

  Model run() {
    add_constants();
    name_coefficients();
    for (std::size_t i = 0; i < request_.effects.size(); ++i) bind(i);
    lend_coefficients();
    check_everything_used();
    check_sizes();
    return std::move(model_);
  }

  std::map<std::string, std::string> curves_without_knots() {
    std::map<std::string, std::string> open;
    name_coefficients();
    for (std::size_t i = 0; i < request_.effects.size(); ++i) {
      const auto& spec = effect(i).spec();
      for (std::size_t c = 0; c < spec.coefficients.size(); ++c) {
        if (spec.coefficients[c].borrowed) continue;
        const auto curve = curve_request(names_[i][c], spec.coefficients[c]);
        if (curve && curve->knots.empty()) open[names_[i][c]] = curve->of;
      }
    }
    return open;
  }

  std::map<std::string, std::string> parameter_units() {
    std::map<std::string, std::string> units;
    for (const auto& constant : system().constants) units[constant.name] = constant.unit;
    name_coefficients();
    for (std::size_t i = 0; i < request_.effects.size(); ++i) {
      const auto& spec = effect(i).spec();
      const auto roles = role_units(request_.effects[i], spec);
      for (std::size_t c = 0; c < spec.coefficients.size(); ++c) {
        if (!spec.coefficients[c].borrowed) units[names_[i][c]] = bind_unit(spec.coefficients[c].unit, roles);
      }
    }
    return units;
  }

 private:
  const SystemSpec& system() const { return model_.system->spec(); }
  const Effect& effect(std::size_t i) const { return registry_.effect(request_.effects[i].kind, request_.effects[i].where); }

  void add_constants() {
    std::vector<std::string> names;
    for (const auto& constant : system().constants) names.push_back(constant.name);
    for (const auto& constant : system().constants) {
      const auto given = request_.constants.find(constant.name);
      if (given == request_.constants.end() && constant.required) {
        throw InputError(request_.system_where,
                         "[geometry] " + constant.name + " is missing: " + constant.doc + " [" + constant.unit + "]");
      }
      Parameter p{constant.name, constant.unit, constant.doc};
      p.value = given == request_.constants.end() ? constant.value : given->second;
      p.lower = constant.lower;
      p.upper = constant.upper;
      const auto where = request_.constants_where.find(constant.name);
      check_bounds(p, where == request_.constants_where.end() ? Source{} : where->second);
      p.scale = p.value != 0.0 ? std::abs(p.value) : 1.0;
      const auto sigma = request_.constant_sigmas.find(constant.name);
      if (sigma != request_.constant_sigmas.end()) p.prior_sigma = sigma->second;
      p.prior_mean = p.value;
      apply_request(p);
      model_.parameters.push_back(p);
    }
  }

  static void check_bounds(const Parameter& p, const Source& where) {
    if (p.value >= p.lower && p.value <= p.upper) return;
    throw InputError(where, p.name + " = " + with_unit(p.value, p.unit) + " is outside its bounds, " + with_unit(p.lower, p.unit) + " to " +
                                with_unit(p.upper, p.unit));
  }

  void apply_request(Parameter& p) {
    const auto found = request_.parameters.find(p.name);
    if (found == request_.parameters.end()) return;
    used_parameters_.insert(p.name);
    const ParameterRequest& r = found->second;
    if (r.lower) p.lower = *r.lower;
    if (r.upper) p.upper = *r.upper;
    if (r.value) p.value = *r.value;
    if (r.free) p.free = *r.free;
    if (r.sigma) p.prior_sigma = r.sigma;
    p.prior_mean = p.value;
    if (!(p.lower < p.upper))
      throw InputError(r.where,
                       "bounds of " + p.name + " must increase: [" + with_unit(p.lower, p.unit) + ", " + with_unit(p.upper, p.unit) + "]");
    check_bounds(p, r.where);
  }

  /// Bare names where unique, EFFECT.NAME where two effects of the model, or an effect and the system, would share one; a system may
  /// rename.
  void name_coefficients() {
    names_.clear();
    std::map<std::string, int> uses;
    for (const auto& constant : system().constants) ++uses[constant.name];
    for (std::size_t i = 0; i < request_.effects.size(); ++i) {
      std::vector<std::string> own;
      for (const auto& c : effect(i).spec().coefficients) {
        const auto renamed = system().coefficient_names.find(c.name);
        own.push_back(renamed == system().coefficient_names.end() ? c.name : renamed->second);
        if (!c.borrowed) ++uses[own.back()];
      }
      names_.push_back(own);
    }
    for (std::size_t i = 0; i < names_.size(); ++i) {
      for (std::size_t c = 0; c < names_[i].size(); ++c) {
        auto& name = names_[i][c];
        if (!effect(i).spec().coefficients[c].borrowed && uses[name] > 1) name = request_.effects[i].name + "." + name;
      }
    }
  }

  /// Borrowed coefficients, once all effects are bound: that of the first effect which owns one of the name.
  void lend_coefficients() {
    for (std::size_t i = 0; i < model_.effects.size(); ++i) {
      const auto& coefficients = effect(i).spec().coefficients;
      for (std::size_t c = 0; c < coefficients.size(); ++c) {
        if (!coefficients[c].borrowed) continue;
        BoundEffect& borrower = model_.effects[i];
        const auto lent = owned_coefficient(coefficients[c].name);
        if (!lent) {
          throw InputError(request_.effects[i].where,
                           "effect '" + borrower.name + "' changes what another effect adds by its coefficient '" + coefficients[c].name +
                               "', and no effect of the model has one" + suggest(coefficients[c].name, owned_names()));
        }
        if (lent->curve >= 0) {
          const Curve& curve = model_.curves[static_cast<std::size_t>(lent->curve)];
          check_order(request_.effects[i].where, "effect '" + borrower.name + "'", curve.of, curve.quantity, borrower.kind);
        }
        borrower.coefficients[c] = *lent;
      }
    }
  }
  std::optional<BoundCoefficient> owned_coefficient(const std::string& name) const {
    for (std::size_t i = 0; i < model_.effects.size(); ++i) {
      const auto& coefficients = effect(i).spec().coefficients;
      for (std::size_t c = 0; c < coefficients.size(); ++c) {
        if (!coefficients[c].borrowed && name == coefficients[c].name) return model_.effects[i].coefficients[c];
      }
    }
    return std::nullopt;
  }
  std::vector<std::string> owned_names() const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < model_.effects.size(); ++i) {
      for (const auto& c : effect(i).spec().coefficients) {
        if (!c.borrowed) names.emplace_back(c.name);
      }
    }
    return names;
  }

  std::optional<CurveRequest> curve_request(const std::string& name, const CoefficientSpec& spec) const {
    const auto found = request_.curves.find(name);
    if (found != request_.curves.end()) return found->second;
    const auto number = request_.parameters.find(name);
    if (spec.curve_of[0] == '\0' || (number != request_.parameters.end() && number->second.value)) return std::nullopt;
    CurveRequest request;
    request.of = spec.curve_of;
    return request;
  }

  void bind(std::size_t i) {
    const EffectRequest& request = request_.effects[i];
    const EffectSpec& spec = effect(i).spec();
    for (std::size_t j = 0; j < i; ++j) {
      if (request_.effects[j].name == request.name) throw InputError(request.where, "effect '" + request.name + "' is named twice");
    }
    if (std::find(system().includes.begin(), system().includes.end(), spec.key) != system().includes.end()) {
      throw InputError(request.where, "effect '" + request.name + "': the equations of system '" + system().key + "' have '" + spec.key +
                                          "' by themselves, it would count twice");
    }
    BoundEffect bound;
    bound.effect = &effect(i);
    bound.name = request.name;
    check_roles(request, spec);
    role_units_ = role_units(request, spec);
    bind_ports(request, spec, bound);
    for (const auto& role : spec.quantities) bound.quantities.push_back(bind_quantity(request, role, bound.kind));
    for (const auto& name : spec.constants) bound.constants.push_back(bind_constant(request, name));
    bound.first_state = static_cast<int>(model_.own_states.size());
    for (const auto& state : spec.states) {
      model_.own_states.push_back(state);
      model_.own_state_names.push_back(request.name + "." + state.name);
      model_.own_state_units.push_back(bind_unit(state.unit, role_units_));
    }
    for (std::size_t c = 0; c < spec.coefficients.size(); ++c)
      bound.coefficients.push_back(bind_coefficient(names_[i][c], spec.coefficients[c], request, bound.kind));
    model_.effects.push_back(std::move(bound));
  }

  /// Unit of what each role stands for; "-" where an optional role is absent (a wrong name is reported when it is bound).
  std::map<std::string, std::string> role_units(const EffectRequest& request, const EffectSpec& spec) const {
    std::map<std::string, std::string> units;
    for (const auto& role : spec.quantities) {
      const int index = find_quantity(target_of(request, role, [&](const std::string& name) { return find_quantity(name) >= 0; }));
      units[role.name] = index < 0 ? "-" : unit_of_quantity(index);
    }
    for (const auto& role : spec.ports) {
      const auto place = find_port(target_of(request, role, [&](const std::string& name) { return find_port(name).has_value(); }));
      units[role.name] = place ? place->unit : "-";
    }
    return units;
  }
  const std::string& unit_of_quantity(int index) const {
    const auto i = static_cast<std::size_t>(index);
    const auto own = system().quantities.size();
    return i < own ? system().quantities[i].unit : system().outputs[i - own].unit;
  }

  static void check_roles(const EffectRequest& request, const EffectSpec& spec) {
    std::vector<std::string> valid;
    for (const auto& role : spec.quantities) valid.emplace_back(role.name);
    for (const auto& role : spec.ports) valid.emplace_back(role.name);
    for (const auto& [role, target] : request.roles) {
      if (std::find(valid.begin(), valid.end(), role) == valid.end()) {
        throw InputError(request.where,
                         "effect '" + request.name + "' (" + spec.key + ") has no role '" + role + "'" + suggest(role, valid));
      }
    }
  }

  /// An optional role that completes another is not looked for where the study binds that one alone.
  static bool is_left_out(const EffectRequest& request, const Role& role) {
    return role.completes[0] != '\0' && request.roles.contains(role.completes) && !request.roles.contains(role.name);
  }

  /// The name a role stands for: as the study binds it, else itself if `exists`, else the system's default for the role.
  template <class Exists>
  std::string target_of(const EffectRequest& request, const Role& role, const Exists& exists) const {
    const auto bound = request.roles.find(role.name);
    if (bound != request.roles.end()) return bound->second;
    if (exists(role.name)) return role.name;
    const auto fallback = system().roles.find(role.name);
    return fallback == system().roles.end() ? role.name : fallback->second;
  }

  struct Place {
    PortKind kind;
    int index;
    std::string unit;
  };
  std::optional<Place> find_port(const std::string& name) const {
    // Dynamic ports first: a quantity port may share the name of the quantity that it changes, never that of a dynamic port.
    const auto search = [&](const auto& list, PortKind kind) -> std::optional<Place> {
      for (std::size_t i = 0; i < list.size(); ++i) {
        if (list[i].name == name) return Place{kind, static_cast<int>(i), list[i].unit};
      }
      return std::nullopt;
    };
    if (auto place = search(system().dynamic_ports, PortKind::dynamic)) return place;
    if (auto place = search(system().quantity_ports, PortKind::quantity)) return place;
    if (auto place = search(system().outputs, PortKind::sensor)) return place;
    if (name == "sample_time") return Place{PortKind::sensor, model_.outputs(), "s"};
    return std::nullopt;
  }
  std::vector<std::string> port_names() const {
    std::vector<std::string> names;
    for (const auto& port : system().dynamic_ports) names.push_back(port.name);
    for (const auto& port : system().quantity_ports) names.push_back(port.name);
    for (const auto& output : system().outputs) names.push_back(output.name);
    names.emplace_back("sample_time");
    return names;
  }

  void bind_ports(const EffectRequest& request, const EffectSpec& spec, BoundEffect& bound) const {
    bool first = true;
    for (const auto& role : spec.ports) {
      if (is_left_out(request, role)) {
        bound.ports.push_back(-1);
        continue;
      }
      const std::string target = target_of(request, role, [&](const std::string& name) { return find_port(name).has_value(); });
      const auto place = find_port(target);
      if (!place) {
        if (role.optional && !request.roles.contains(role.name)) {
          bound.ports.push_back(-1);
          continue;
        }
        throw InputError(request.where, "effect '" + request.name + "': system '" + system().key + "' has no port '" + target + "'" +
                                            suggest(target, port_names()));
      }
      check_unit(request, role, "port '" + target + "'", place->unit);
      if (!first && place->kind != bound.kind) {
        throw InputError(request.where, "effect '" + request.name + "' cannot add to '" + target +
                                            "' beside its other ports: they are of different kinds");
      }
      bound.kind = place->kind;
      first = false;
      bound.ports.push_back(place->index);
    }
  }

  static void check_unit(const EffectRequest& request, const Role& role, const std::string& what, const std::string& unit) {
    if (role.unit[0] == '*') return;  // a generic role takes any unit
    if (!parse_unit(role.unit).same_dimension(parse_unit(unit))) {
      throw InputError(request.where, "effect '" + request.name + "': role '" + role.name + "' needs [" + role.unit + "], " + what +
                                          " has [" + unit + "]");
    }
  }

  int bind_quantity(const EffectRequest& request, const Role& role, PortKind kind) const {
    if (is_left_out(request, role)) return -1;
    const std::string target = target_of(request, role, [&](const std::string& name) { return find_quantity(name) >= 0; });
    const int index = find_quantity(target);
    if (index < 0) {
      if (role.optional && !request.roles.contains(role.name)) return -1;
      throw InputError(request.where, "effect '" + request.name + "': system '" + system().key + "' has no quantity '" + target + "'" +
                                          suggest(target, quantity_names()));
    }
    check_order(request.where, "effect '" + request.name + "'", target, index, kind);
    check_unit(request, role, "quantity '" + target + "'", unit_of_quantity(index));
    return index;
  }

  /// Effects on quantity ports read base quantities only; only effects on sensors read predicted outputs (DESIGN 4, order of evaluation).
  void check_order(const Source& where, const std::string& who, const std::string& target, int index, PortKind kind) const {
    if (kind == PortKind::quantity && index >= system().base_quantities) {
      throw InputError(where, who + " changes a quantity and so cannot read '" + target + "', which depends on such changes");
    }
    if (kind != PortKind::sensor && index >= static_cast<int>(system().quantities.size())) {
      throw InputError(where, who + " cannot read the predicted output '" + target + "': only effects on sensors can");
    }
  }

  int find_quantity(const std::string& name) const {
    const auto& list = system().quantities;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (list[i].name == name) return static_cast<int>(i);
    }
    const auto& outputs = system().outputs;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      if (outputs[i].name == name) return static_cast<int>(list.size() + i);
    }
    return -1;
  }
  std::vector<std::string> quantity_names() const {
    std::vector<std::string> names;
    for (const auto& quantity : system().quantities) names.push_back(quantity.name);
    return names;
  }

  int bind_constant(const EffectRequest& request, const std::string& name) const {
    const auto& constants = system().constants;
    for (std::size_t i = 0; i < constants.size(); ++i) {
      if (constants[i].name == name) return static_cast<int>(i);
    }
    throw InputError(request.where,
                     "effect '" + request.name + "' needs '" + name + "', which system '" + system().key + "' does not have");
  }

  BoundCoefficient bind_coefficient(const std::string& name, const CoefficientSpec& spec, const EffectRequest& request, PortKind kind) {
    if (spec.borrowed) return {};  // see lend_coefficients()
    const auto curve = curve_request(name, spec);
    if (curve) return {-1, add_curve(name, spec, *curve, request, kind)};
    if (spec.over_sine) throw InputError(request.where, name + " must be a curve: give [curves] " + name + " = { of = \"alpha_T\" }");
    Parameter p = as_parameter(name, spec);
    apply_request(p);
    model_.parameters.push_back(p);
    return {static_cast<int>(model_.parameters.size()) - 1, -1};
  }

  Parameter as_parameter(const std::string& name, const CoefficientSpec& spec) const {
    Parameter p{name, bind_unit(spec.unit, role_units_), spec.doc};
    p.value = spec.value;
    p.lower = spec.lower;
    p.upper = spec.upper;
    p.scale = spec.scale;
    p.free = !spec.fixed;
    p.kind = spec.kind;
    return p;
  }

  int add_curve(const std::string& name, const CoefficientSpec& spec, const CurveRequest& request, const EffectRequest& by, PortKind kind) {
    used_curves_.insert(name);
    if (request.of.empty())
      throw InputError(request.where, "curve " + name + ": `of` must name a quantity" + suggest("", quantity_names()));
    Curve curve;
    curve.name = name;
    curve.of = request.of;
    curve.unit = bind_unit(spec.unit, role_units_);
    curve.quantity = find_quantity(request.of);
    if (curve.quantity < 0) {
      throw InputError(request.where, "curve " + name + ": system '" + system().key + "' has no quantity '" + request.of + "'" +
                                          suggest(request.of, quantity_names()));
    }
    check_order(request.where, "effect '" + by.name + "'", request.of, curve.quantity, kind);
    const bool own = curve.quantity < static_cast<int>(system().quantities.size());
    curve.of_unit = unit_of_quantity(curve.quantity);
    curve.over_sine = spec.over_sine && own && !system().quantities[static_cast<std::size_t>(curve.quantity)].carries_sign;
    curve.roughness = request.roughness;
    curve.scale = spec.scale;
    try {
      curve.spline = CubicSpline(request.knots, spec.parity);
    } catch (const InputError& error) {
      throw InputError(request.where, "curve " + name + ": " + error.what());
    }
    curve.first = static_cast<int>(model_.parameters.size());
    add_curve_parameters(curve, spec);
    model_.curves.push_back(std::move(curve));
    return static_cast<int>(model_.curves.size()) - 1;
  }

  /// One parameter per spline coefficient. What [parameters] says of the curve holds for each: they sum to one, so bounds on them are
  /// bounds on the curve.
  void add_curve_parameters(const Curve& curve, const CoefficientSpec& spec) {
    Parameter p = as_parameter(curve.name, spec);
    p.free = true;
    apply_request(p);
    p.curve = static_cast<int>(model_.curves.size());
    for (int i = 0; i < curve.spline.size(); ++i) {
      p.name = curve.name + "[" + std::to_string(i) + "]";
      model_.parameters.push_back(p);
    }
  }

  void check_everything_used() const {
    std::vector<std::string> names, curves;
    for (const auto& p : model_.parameters) {
      if (p.curve < 0) names.push_back(p.name);
    }
    for (const auto& list : names_) curves.insert(curves.end(), list.begin(), list.end());
    for (const auto& curve : model_.curves) names.push_back(curve.name);
    for (const auto& [name, request] : request_.parameters) {
      if (!used_parameters_.contains(name))
        throw InputError(request.where, "[parameters]: the model has no parameter '" + name + "'" + suggest(name, names));
    }
    for (const auto& [name, request] : request_.curves) {
      if (!used_curves_.contains(name))
        throw InputError(request.where, "[curves]: the model has no coefficient '" + name + "'" + suggest(name, curves));
    }
  }

  void check_sizes() const {
    const auto limit = [&](std::size_t have, int most, const char* what) {
      if (have > static_cast<std::size_t>(most))
        throw InputError(request_.system_where,
                         "the model has " + std::to_string(have) + " " + what + "; at most " + std::to_string(most) + " are possible");
    };
    limit(static_cast<std::size_t>(model_.states()), kMaxStates, "states");
    limit(system().quantities.size() + system().outputs.size(), kMaxQuantities, "quantities");
    limit(system().dynamic_ports.size() + model_.own_states.size(), kMaxPorts, "dynamic ports and own states");
    limit(system().quantity_ports.size(), kMaxPorts, "quantity ports");
    limit(system().inputs.size(), kMaxInputs, "inputs");
    limit(system().outputs.size(), kMaxOutputs, "outputs");
    limit(system().constants.size(), kMaxConstants, "constants");
    limit(model_.free_parameters().size(), kMaxColumns, "free parameters");
  }

  const ModelRequest& request_;
  const Registry& registry_;
  Model model_;
  std::vector<std::vector<std::string>> names_;
  std::set<std::string> used_parameters_, used_curves_;
  std::map<std::string, std::string> role_units_;  // of the effect being bound
};

}  // namespace

Model assemble(const ModelRequest& request, const Registry& registry) { return Assembler(request, registry).run(); }

std::map<std::string, std::string> curves_without_knots(const ModelRequest& request, const Registry& registry) {
  return Assembler(request, registry).curves_without_knots();
}

std::map<std::string, std::string> parameter_units(const ModelRequest& request, const Registry& registry) {
  return Assembler(request, registry).parameter_units();
}

}  // namespace misfit
