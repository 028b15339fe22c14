#include "misfit/discover/bindings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "misfit/model/evaluator.h"

namespace misfit {
namespace {

bool has_role(const std::vector<Role>& roles, std::string_view name) {
  return std::any_of(roles.begin(), roles.end(), [&](const Role& r) { return name == r.name; });
}

const StateSpec* state_called(const SystemSpec& system, const std::string& name) {
  const auto found = std::find_if(system.states.begin(), system.states.end(), [&](const StateSpec& s) { return s.name == name; });
  return found == system.states.end() ? nullptr : &*found;
}

/// Ports on which generic effects make sense by themselves, with the roles that their conjugate state plays.
std::vector<Roles> natural_ports(const SystemSpec& system) {
  std::vector<Roles> out;
  for (const auto& port : system.dynamic_ports) {
    const bool forced = std::find(system.force_ports.begin(), system.force_ports.end(), port.name) != system.force_ports.end();
    const StateSpec* state = state_called(system, port.conjugate);
    if (state == nullptr || (!forced && !system.force_ports.empty())) continue;
    Roles roles = {{"port", port.name}};
    if (state->rate_of >= 0) {
      const std::string& moved = system.states[state->rate_of].name;
      roles.insert({{"rate", state->name}, {"displacement", moved}, {"level", moved}});
    } else {
      roles["level"] = state->name;
    }
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
      constexpr std::array<std::string_view, 5> kinds = {"rate", "displacement", "level", "port", "to_port"};
      if (!role.optional && std::find(kinds.begin(), kinds.end(), role.name) != kinds.end()) return std::nullopt;
    }
  }
  return out;
}

/// Each place once per value of a further role.
std::vector<Roles> times(const std::vector<Roles>& places, const std::string& role, const std::vector<std::string>& values) {
  std::vector<Roles> out;
  for (const Roles& place : places) {
    for (const std::string& value : values) {
      const auto port = place.find("port");
      if (port != place.end() && port->second == value) continue;  // nothing spills into itself
      out.push_back(place);
      out.back()[role] = value;
    }
  }
  return out;
}

template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  for (const auto& item : list) names.push_back(item.name);
  return names;
}

std::optional<OperatingRange::Range> range_of(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.size() < 2) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t cut = values.size() / 200;
  const OperatingRange::Range range{values[cut], values[values.size() - 1 - cut]};
  if (!(range.high > range.low)) return std::nullopt;
  return range;
}

}  // namespace

bool is_generic(const EffectSpec& effect) {
  return std::any_of(effect.ports.begin(), effect.ports.end(), [](const Role& r) { return r.unit[0] == '*' || r.unit[0] == '{'; });
}

std::vector<Roles> enumerate_bindings(const EffectSpec& effect, const SystemSpec& system) {
  std::vector<Roles> out = {{}};
  if (!is_generic(effect)) return out;
  std::vector<Roles> places = {{}};
  if (has_role(effect.ports, "port") || has_role(effect.ports, "to_port")) places = natural_ports(system);
  if (has_role(effect.ports, "to_port")) {
    std::vector<std::string> ports;
    for (const Roles& place : places) ports.push_back(place.at("port"));
    places = times(places, "to_port", ports);
  }
  if (has_role(effect.quantities, "input"))
    places = times(places, "input", system.roles.contains("input") ? names_of(system.inputs) : std::vector<std::string>{});
  if (has_role(effect.ports, "output"))
    places = times(places, "output", system.roles.contains("signal") ? names_of(system.outputs) : std::vector<std::string>{});
  for (const Roles& place : places) {
    const auto roles = roles_at(effect, place);
    if (roles && !roles->empty()) out.push_back(*roles);
  }
  return out;
}

OperatingRange::OperatingRange(const FilterEstimate& estimate) {
  const SystemSpec& system = estimate.model.system->spec();
  Evaluator evaluator(estimate.forced.model);
  const std::size_t count = system.quantities.size();
  std::vector<std::vector<double>> values(count + system.outputs.size());
  std::vector<double> q(count), steps;
  for (std::size_t e = 0; e < estimate.traces.size(); ++e) {
    const FilterTrace& trace = estimate.traces[e];
    const FilterData& data = estimate.data[e];
    for (std::size_t k = data.first; k < trace.samples; ++k) {
      evaluator.quantities(trace.filtered(k).data(), data.inputs.at(k), data.signals->t[k], q.data());
      for (std::size_t i = 0; i < count; ++i) values[i].push_back(q[i]);
      if (k > data.first) steps.push_back(data.signals->t[k] - data.signals->t[k - 1]);
    }
    for (std::size_t o = 0; o < system.outputs.size(); ++o) {
      for (const Signal& channel : data.signals->measured) {
        if (channel.name == system.outputs[o].name)
          values[count + o].insert(values[count + o].end(), channel.values.begin(), channel.values.end());
      }
    }
  }
  for (auto& list : values) ranges_.push_back(range_of(std::move(list)));
  if (steps.empty()) return;
  const auto middle = steps.begin() + steps.size() / 2;
  std::nth_element(steps.begin(), middle, steps.end());
  step_ = *middle;
}

std::optional<OperatingRange::Range> OperatingRange::range(int quantity) const {
  const std::size_t i = quantity;
  return quantity < 0 || i >= ranges_.size() ? std::nullopt : ranges_[i];
}

std::vector<double> OperatingRange::grid(const BoundEffect& effect, std::size_t coefficient) const {
  const EffectSpec& spec = effect.effect->spec();
  const CoefficientSpec& c = spec.coefficients[coefficient];
  const std::string_view over = c.scan.over;
  const bool size = over.starts_with('|') && over.ends_with('|') && over.size() > 2;
  double origin = 0.0, unit = 1.0;
  if (over == "step") {
    unit = step_;
  } else if (!over.empty()) {
    const std::string_view role = size ? over.substr(1, over.size() - 2) : over;
    const auto found = std::find_if(spec.quantities.begin(), spec.quantities.end(), [&](const Role& r) { return role == r.name; });
    const auto range = found == spec.quantities.end() ? std::nullopt : this->range(effect.quantities[found - spec.quantities.begin()]);
    if (!range) return {c.value};
    origin = size ? 0.0 : range->low;
    unit = size ? std::max(std::abs(range->low), std::abs(range->high)) : range->high - range->low;
  }
  std::vector<double> out;
  for (int i = 0; i < c.scan.count; ++i) {
    const int steps = std::max(c.scan.count - 1, 1);
    const double share = size || over == "step" ? c.scan.from * std::pow(c.scan.to / c.scan.from, static_cast<double>(i) / steps)
                                                : c.scan.from + (c.scan.to - c.scan.from) * i / steps;
    out.push_back(std::clamp(origin + unit * share, c.lower, c.upper));
  }
  return out;
}

}  // namespace misfit
