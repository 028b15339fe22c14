#include "misfit/discover/bindings.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "misfit/core/lists.h"
#include "misfit/core/units.h"
#include "misfit/model/declared.h"
#include "misfit/model/rate_port.h"
#include "misfit/model/rate_unit.h"

namespace misfit {
namespace {

bool has_role(const std::vector<Role>& roles, std::string_view name) {
  return std::any_of(roles.begin(), roles.end(), [&](const Role& r) { return name == r.name; });
}

const StateSpec* state_called(const SystemSpec& system, const std::string& name) {
  const auto found = std::find_if(system.states.begin(), system.states.end(), [&](const StateSpec& s) { return s.name == name; });
  return found == system.states.end() ? nullptr : &*found;
}

/// Roles that the conjugate of a port plays: a state, or a quantity that a declared port calls its rate. `speed` is a rate of which nothing
/// is the displacement.
Roles roles_of_conjugate(const SystemSpec& system, const std::string& name) {
  const StateSpec* state = state_called(system, name);
  const auto quantity =
      std::find_if(system.quantities.begin(), system.quantities.end(), [&](const QuantitySpec& q) { return q.name == name; });
  if (state != nullptr && state->rate_of >= 0) {
    const std::string& moved = system.states[state->rate_of].name;
    return {{"rate", name}, {"displacement", moved}, {"level", moved}};
  }
  if (state != nullptr && is_per_time(state->unit)) return {{"level", name}, {"rate", name}, {"speed", name}};
  if (state != nullptr) return {{"level", name}, {"content", name}};
  if (quantity == system.quantities.end()) return {};
  if (!quantity->rate_of.empty()) return {{"rate", name}, {"displacement", quantity->rate_of}, {"level", quantity->rate_of}};
  return is_per_time(quantity->unit) ? Roles{{"rate", name}} : Roles{};
}

/// It has a default for `signal`: its way of saying that generic effects make sense at places of its own.
bool suggests_places(const SystemSpec& system) { return system.roles.contains("signal"); }

/// Ports on which generic effects make sense by themselves: those of the random force, and those that a system declares.
std::vector<Roles> natural_ports(const SystemSpec& system) {
  std::vector<Roles> out;
  for (const auto& port : system.dynamic_ports) {
    const bool forced = std::find(system.force_ports.begin(), system.force_ports.end(), port.name) != system.force_ports.end();
    const bool natural = forced || system.force_ports.empty() || (!is_rate_port(port) && suggests_places(system));
    if (port.conjugate.empty() || !natural) continue;
    Roles roles = roles_of_conjugate(system, port.conjugate);
    if (roles.empty()) continue;
    roles["port"] = port.name;
    out.push_back(std::move(roles));
  }
  return out;
}

/// Of a place, the roles that the effect has; nullopt if it has a required role of a kind that the place lacks.
std::optional<Roles> roles_at(const EffectSpec& effect, const Roles& place) {
  Roles out;
  for (const auto* list : {&effect.quantities, &effect.ports}) {
    for (const Role& role : *list) {
      const auto found = place.find(role.name);
      if (found != place.end()) {
        out[role.name] = found->second;
        continue;
      }
      constexpr std::array<std::string_view, 9> kinds = {"rate",  "displacement", "level", "content", "speed",
                                                         "other", "factor",       "port",  "to_port"};
      if (!role.optional && std::find(kinds.begin(), kinds.end(), role.name) != kinds.end()) return std::nullopt;
    }
  }
  return out;
}

/// Each place once per value of a further role. Nothing spills into itself, nor does an input drive the exchange with itself.
std::vector<Roles> times(const std::vector<Roles>& places, const std::string& role, const std::vector<std::string>& values) {
  const auto plays = [](const Roles& place, const char* part, const std::string& value) {
    const auto found = place.find(part);
    return found != place.end() && found->second == value;
  };
  std::vector<Roles> out;
  for (const Roles& place : places) {
    for (const std::string& value : values) {
      if (plays(place, "port", value) || plays(place, "other", value)) continue;
      out.push_back(place);
      out.back()[role] = value;
    }
  }
  return out;
}

/// The places, and each of them with every input of the displacement's unit in its place.
std::vector<Roles> with_inputs_that_displace(std::vector<Roles> places, const SystemSpec& system) {
  const std::size_t count = places.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto displacement = places[i].find("displacement");
    const StateSpec* moved = displacement == places[i].end() ? nullptr : state_called(system, displacement->second);
    if (moved == nullptr) continue;
    for (const InputSpec& input : system.inputs) {
      if (!parse_unit(input.unit).same_dimension(parse_unit(moved->unit))) continue;
      places.push_back(places[i]);
      places.back()["displacement"] = input.name;
    }
  }
  return places;
}

bool may_be_an_input(const EffectSpec& effect, std::string_view role) {
  return std::any_of(effect.quantities.begin(), effect.quantities.end(), [&](const Role& r) { return r.input_too && role == r.name; });
}

/// Each place once per other state, and input where `inputs_too`, of the unit that its level has.
std::vector<Roles> times_other_levels(const std::vector<Roles>& places, const SystemSpec& system, bool inputs_too) {
  std::vector<Roles> out;
  for (const Roles& place : places) {
    const StateSpec* level = place.contains("level") ? state_called(system, place.at("level")) : nullptr;
    if (level == nullptr) continue;
    const auto add = [&](const auto& other) {
      if (other.name == level->name || !parse_unit(other.unit).same_dimension(parse_unit(level->unit))) return;
      out.push_back(place);
      out.back()["other"] = other.name;
    };
    for (const StateSpec& state : system.states) add(state);
    if (!inputs_too) continue;
    for (const InputSpec& input : system.inputs) add(input);
  }
  return out;
}

/// Without those where a role stands for a state of a kind that it never is (Role::never).
std::vector<Roles> without_what_it_never_is(std::vector<Roles> places, const EffectSpec& effect, const SystemSpec& system) {
  for (const Role& role : effect.quantities) {
    std::erase_if(places, [&](const Roles& place) {
      const StateSpec* state = place.contains(role.name) ? state_called(system, place.at(role.name)) : nullptr;
      return state != nullptr && std::any_of(role.never.begin(), role.never.end(),
                                             [&](const char* unit) { return parse_unit(state->unit).same_dimension(parse_unit(unit)); });
    });
  }
  return places;
}

/// Each place once per state that plays a part in it.
std::vector<Roles> times_factors(const std::vector<Roles>& places) {
  std::vector<Roles> out;
  for (const Roles& place : places) {
    std::set<std::string> factors;
    for (const char* role : {"rate", "level"}) {
      if (!place.contains(role) || !factors.insert(place.at(role)).second) continue;
      out.push_back(place);
      out.back()["factor"] = place.at(role);
    }
  }
  return out;
}

bool is_small(const SystemSpec& system) { return system.states.size() <= states_of_a_small_system; }

/// Each place whose factor is a state once per other state that may multiply it, each pair once: an input is what sets how strongly a state
/// acts, and so may another state be (a rate constant and a concentration, a damping that depends on the position). Of small systems.
std::vector<Roles> times_other_states(const std::vector<Roles>& places, const SystemSpec& system) {
  std::vector<Roles> out;
  if (!suggests_places(system) || !is_small(system)) return out;
  std::set<std::array<std::string, 3>> known;
  for (const Roles& place : places) {
    const std::string& factor = place.at("factor");
    if (state_called(system, factor) == nullptr) continue;
    for (const StateSpec& state : system.states) {
      const auto [first, second] = std::minmax(factor, state.name);
      if (state.name == factor || !known.insert({place.at("port"), first, second}).second) continue;
      out.push_back(place);
      out.back()["input"] = state.name;
    }
  }
  return out;
}

/// Each place with its output once per other output of the same unit; where the effect writes both, each pair of outputs once.
std::vector<Roles> times_other_outputs(const std::vector<Roles>& places, const SystemSpec& system, bool writes_both) {
  std::vector<Roles> out;
  for (const Roles& place : places) {
    const auto own = std::find_if(system.outputs.begin(), system.outputs.end(),
                                  [&](const OutputSpec& o) { return place.contains("output") && o.name == place.at("output"); });
    if (own == system.outputs.end()) continue;
    for (auto other = writes_both ? own + 1 : system.outputs.begin(); other != system.outputs.end(); ++other) {
      if (other == own || !parse_unit(other->unit).same_dimension(parse_unit(own->unit))) continue;
      out.push_back(place);
      out.back()["other_signal"] = other->name;
      if (writes_both) out.back()["other_output"] = other->name;
    }
  }
  return out;
}

/// Of a single output that time is the time of all.
std::vector<Roles> times_of_outputs(const SystemSpec& system) {
  std::vector<Roles> out;
  if (!suggests_places(system) || system.outputs.size() < 2) return out;
  for (const OutputSpec& output : system.outputs) out.push_back({{"time_of_output", sample_time_of(output.name)}});
  return out;
}

template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  for (const auto& item : list) names.push_back(item.name);
  return names;
}

/// It acts in one equation, through one state or input or none.
bool is_factor(const PortSpec& parameter) { return !parameter.conjugate.empty() || !parameter.multiplies.empty(); }

/// Each parameter that may vary, once per state and input.
std::vector<Roles> varying_parameters(const SystemSpec& system) {
  std::vector<std::string> values = names_of(system.states);
  for (const InputSpec& input : system.inputs) values.push_back(input.name);
  std::vector<Roles> out;
  for (const std::string& name : ports_of_parameters(system, true)) {
    const PortSpec& port = system.quantity_ports[index_of(system.quantity_ports, name)];
    if (!port.conjugate.empty()) continue;
    for (const std::string& with : values) {
      if (is_more_than_a_force(port, with)) out.push_back({{"parameter", name}, {"with", with}});
    }
  }
  return out;
}

bool may_be_a_parameter(const EffectSpec& effect) {
  return std::any_of(effect.ports.begin(), effect.ports.end(), [](const Role& r) { return r.parameter_too; });
}

/// A factor that goes up and down as the motion does is what any nonlinearity of it looks like.
bool has_frequency(const EffectSpec& effect) {
  return std::any_of(effect.coefficients.begin(), effect.coefficients.end(),
                     [](const CoefficientSpec& c) { return c.scan.is_frequency(); });
}

bool is_in_outputs(const SystemSpec& system, const std::string& port) {
  return std::find(system.ports_in_outputs.begin(), system.ports_in_outputs.end(), port) != system.ports_in_outputs.end();
}

/// A whole one has the gain that the model has for its input: its refit belongs to the input itself (on_its_input()).
bool is_of_its_input(const EffectSpec& effect) {
  return std::any_of(effect.coefficients.begin(), effect.coefficients.end(),
                     [](const CoefficientSpec& c) { return std::string_view(c.whole_of) == "input"; });
}

/// The places, and every input that an output's formula reads as a place of its own: a force elsewhere does not show in that output. An
/// effect of the input itself is there only.
std::vector<Roles> with_inputs_in_outputs(std::vector<Roles> places, const EffectSpec& effect, const SystemSpec& system) {
  for (const InputSpec& input : system.inputs) {
    if (!is_in_outputs(system, input.name)) continue;
    if (is_of_its_input(effect)) std::erase_if(places, [&](const Roles& place) { return place.at("input") == input.name; });
    places.push_back({{"input", input.name}, {"port", input.name}});
  }
  return places;
}

}  // namespace

bool is_generic(const EffectSpec& effect) {
  return std::any_of(effect.ports.begin(), effect.ports.end(), [](const Role& r) { return r.unit[0] == '*' || r.unit[0] == '{'; });
}

bool is_more_than_a_force(const PortSpec& parameter, const std::string& quantity) {
  return !is_factor(parameter) || (!parameter.multiplies.empty() && parameter.multiplies != quantity);
}

std::vector<std::string> ports_of_parameters(const SystemSpec& system, bool factors) {
  std::vector<std::string> out;
  if (!is_small(system)) return out;
  for (const PortSpec& port : system.quantity_ports) {
    const int parameter = index_of(system.constants, port.name);
    if (parameter >= 0 && system.constants[parameter].free && (factors || !is_factor(port))) out.push_back(port.name);
  }
  return out;
}

std::vector<Roles> enumerate_bindings(const EffectSpec& effect, const SystemSpec& system) {
  std::vector<Roles> out = {{}};
  if (has_role(effect.ports, all_sample_times) && system.inputs.empty()) return {};
  if (has_role(effect.ports, "time_of_output")) return times_of_outputs(system);
  if (has_role(effect.ports, "parameter")) return varying_parameters(system);
  if (!is_generic(effect)) return out;
  std::vector<Roles> places = {{}};
  if (has_role(effect.ports, "port") || has_role(effect.ports, "to_port")) places = natural_ports(system);
  if (may_be_a_parameter(effect)) {
    for (const std::string& port : ports_of_parameters(system, !has_frequency(effect))) places.push_back({{"port", port}});
  }
  if (may_be_an_input(effect, "displacement")) places = with_inputs_that_displace(std::move(places), system);
  if (has_role(effect.ports, "to_port")) {
    std::vector<std::string> ports;
    for (const Roles& place : places) ports.push_back(place.at("port"));
    places = times(places, "to_port", ports);
  }
  places = without_what_it_never_is(std::move(places), effect, system);
  if (has_role(effect.quantities, "other")) places = times_other_levels(places, system, may_be_an_input(effect, "other"));
  if (has_role(effect.quantities, "factor")) places = times_factors(places);
  if (has_role(effect.quantities, "input")) {
    const std::vector<Roles> products = has_role(effect.quantities, "factor") ? times_other_states(places, system) : std::vector<Roles>{};
    places = times(places, "input", system.roles.contains("input") ? names_of(system.inputs) : std::vector<std::string>{});
    if (has_role(effect.ports, "port")) {
      places = with_inputs_in_outputs(std::move(places), effect, system);
      if (is_of_its_input(effect) && is_in_outputs(system, system.roles.contains("input") ? system.roles.at("input") : "")) out.clear();
    }
    places.insert(places.end(), products.begin(), products.end());
  }
  if (has_role(effect.ports, "output"))
    places = times(places, "output", suggests_places(system) ? names_of(system.outputs) : std::vector<std::string>{});
  if (has_role(effect.quantities, "other_signal")) places = times_other_outputs(places, system, has_role(effect.ports, "other_output"));
  for (const Roles& place : places) {
    const auto roles = roles_at(effect, place);
    if (roles && !roles->empty()) out.push_back(*roles);
  }
  return out;
}

}  // namespace misfit
