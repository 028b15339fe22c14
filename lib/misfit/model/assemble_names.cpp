// What things are called in a model, and where a name leads.

#include <algorithm>

#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/model/assembler.h"
#include "misfit/model/does_not_suit.h"
#include "misfit/model/role_units.h"

namespace misfit {
namespace {

/// ": coulomb_friction has one, and comes first"; empty: no effect that there is has one.
std::string who_has(const std::string& coefficient, const Registry& registry) {
  std::vector<std::string> out;
  for (const std::string& key : registry.effect_keys()) {
    const auto& all = registry.effect(key).spec().coefficients;
    if (std::any_of(all.begin(), all.end(), [&](const CoefficientSpec& c) { return !c.shared && coefficient == c.name; }))
      out.push_back(key);
  }
  return out.empty() ? "" : ": " + join_words(out) + (out.size() > 1 ? " have one; one of them comes first" : " has one, and comes first");
}

}  // namespace

void Assembler::name_coefficients() {
  names_.clear();
  std::map<std::string, int> uses;
  for (const auto& constant : system().constants) ++uses[constant.name];
  for (std::size_t i = 0; i < request_.effects.size(); ++i) {
    std::vector<std::string> own;
    for (const auto& c : effect(i).spec().coefficients) {
      const auto renamed = system().coefficient_names.find(c.name);
      own.push_back(renamed == system().coefficient_names.end() ? c.name : renamed->second);
      if (!c.shared) ++uses[own.back()];
    }
    names_.push_back(own);
  }
  for (std::size_t i = 0; i < names_.size(); ++i) {
    for (std::size_t c = 0; c < names_[i].size(); ++c) {
      auto& name = names_[i][c];
      if (!effect(i).spec().coefficients[c].shared && uses[name] > 1) name = request_.effects[i].name + "." + name;
    }
  }
  find_other_names();
}

void Assembler::find_other_names() {
  std::set<std::string> owned;
  for (const auto& constant : system().constants) owned.insert(constant.name);
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const std::string prefix = request_.effects[i].name + ".";
    for (std::size_t c = 0; c < names_[i].size(); ++c) {
      if (effect(i).spec().coefficients[c].shared) continue;
      const std::string& name = names_[i][c];
      const bool prefixed = name.starts_with(prefix);
      const std::string bare = prefixed ? name.substr(prefix.size()) : name;
      const bool first = owned.insert(bare).second;
      if (!prefixed) other_names_[name] = prefix + name;
      if (prefixed && first) other_names_[name] = bare;
    }
  }
}

void Assembler::share_coefficients() {
  for (std::size_t i = 0; i < model_.effects.size(); ++i) {
    const auto& coefficients = effect(i).spec().coefficients;
    for (std::size_t c = 0; c < coefficients.size(); ++c) {
      if (!coefficients[c].shared) continue;
      BoundEffect& user = model_.effects[i];
      const auto lent = owned_coefficient(coefficients[c].name);
      if (!lent) {
        throw DoesNotSuit(request_.effects[i].where,
                          "effect '" + shown(user.name) + "' changes what another effect adds by its coefficient '" + coefficients[c].name +
                              "', and no effect of the model has one" + who_has(coefficients[c].name, registry_));
      }
      if (lent->curve >= 0) {
        const Curve& curve = model_.curves[lent->curve];
        check_order(request_.effects[i].where, "effect '" + shown(user.name) + "'", curve.of, curve.quantity, user.kind);
      }
      user.coefficients[c] = *lent;
    }
  }
}

std::optional<BoundCoefficient> Assembler::owned_coefficient(const std::string& name) const {
  for (std::size_t i = 0; i < model_.effects.size(); ++i) {
    const auto& coefficients = effect(i).spec().coefficients;
    for (std::size_t c = 0; c < coefficients.size(); ++c) {
      if (!coefficients[c].shared && name == coefficients[c].name) return model_.effects[i].coefficients[c];
    }
  }
  return std::nullopt;
}

std::string Assembler::curve_in_request(const std::string& name) const {
  const auto other = other_names_.find(name);
  return !request_.curves.contains(name) && other != other_names_.end() && request_.curves.contains(other->second) ? other->second : name;
}

std::optional<CurveRequest> Assembler::curve_request(const std::string& name, const CoefficientSpec& spec, const EffectRequest& by) const {
  const auto found = request_.curves.find(curve_in_request(name));
  const ParameterRequest* number = parameter_request(name);
  const bool asked = found != request_.curves.end(), is_number = number != nullptr && number->value;
  if (!asked && (spec.curve_of[0] == '\0' || is_number)) return std::nullopt;
  CurveRequest request = asked ? found->second : CurveRequest{};
  if (!request.of.empty()) return request;
  const EffectSpec& effect = registry_.effect(by.kind, by.where).spec();
  const int role = effect.curve_role(spec);
  request.of = role < 0 ? spec.curve_of
                        : target_of(by, effect.quantities[role], [&](const std::string& quantity) { return find_quantity(quantity) >= 0; });
  return request;
}

std::map<std::string, std::string> Assembler::role_units(const EffectRequest& request, const EffectSpec& spec) const {
  std::map<std::string, std::string> units;
  for (const auto& role : spec.quantities) {
    const int index = find_quantity(role, target_of(request, role, [&](const std::string& name) { return find_quantity(name) >= 0; }));
    units[role.name] = index < 0 ? "-" : unit_of_quantity(index);
  }
  for (const auto& role : spec.ports) {
    const auto place = find_port(role, target_of(request, role, [&](const std::string& name) { return find_port(name).has_value(); }));
    units[role.name] = place ? place->unit : "-";
  }
  return units;
}

const std::string& Assembler::unit_of_quantity(int index) const {
  const int own = int_size(system().quantities);
  return index < own ? system().quantities[index].unit : system().outputs[index - own].unit;
}

std::optional<Assembler::Place> Assembler::find_port(const std::string& name) const {
  // Dynamic ports first: a quantity port may share the name of the quantity that it changes, never that of a dynamic port.
  const auto search = [&](const auto& list, PortKind kind) -> std::optional<Place> {
    const int i = index_of(list, name);
    return i < 0 ? std::nullopt : std::optional(Place{kind, i, list[i].unit});
  };
  if (auto place = search(system().dynamic_ports, PortKind::dynamic)) return place;
  if (auto place = search(system().quantity_ports, PortKind::quantity)) return place;
  if (auto place = search(system().outputs, PortKind::sensor)) return place;
  if (name == all_sample_times) return Place{PortKind::sensor, model_.outputs(), "s"};
  for (int o = 0; o < model_.outputs(); ++o) {
    if (name == sample_time_of(system().outputs[o].name)) return Place{PortKind::sensor, model_.outputs() + 1 + o, "s"};
  }
  return std::nullopt;
}

/// Index of the output; −1: the name means something else, or the same.
int Assembler::namesake_for(const Role& role, const std::string& name) const {
  const std::string_view called = role.name;
  if (called != "output" && called != "other_output" && called != "signal" && called != "other_signal") return -1;
  const int output = index_of(system().outputs, name);
  return output >= 0 && system().outputs[output].namesake ? output : -1;
}

std::optional<Assembler::Place> Assembler::find_port(const Role& role, const std::string& name) const {
  const int output = namesake_for(role, name);
  return output < 0 ? find_port(name) : std::optional(Place{PortKind::sensor, output, system().outputs[output].unit});
}

std::vector<std::string> Assembler::port_names() const {
  std::vector<std::string> names;
  for (const auto& port : system().dynamic_ports) names.push_back(port.name);
  for (const auto& port : system().quantity_ports) names.push_back(port.name);
  for (const auto& output : system().outputs) names.push_back(output.name);
  names.emplace_back(all_sample_times);
  for (const auto& output : system().outputs) names.push_back(sample_time_of(output.name));
  return names;
}

int Assembler::find_quantity(const std::string& name) const {
  const int own = index_of(system().quantities, name), output = index_of(system().outputs, name);
  return own >= 0 || output < 0 ? own : int_size(system().quantities) + output;
}

int Assembler::find_quantity(const Role& role, const std::string& name) const {
  const int output = namesake_for(role, name);
  return output < 0 ? find_quantity(name) : int_size(system().quantities) + output;
}

std::vector<std::string> Assembler::quantity_names() const {
  std::vector<std::string> names;
  for (const auto& quantity : system().quantities) names.push_back(quantity.name);
  return names;
}

}  // namespace misfit
