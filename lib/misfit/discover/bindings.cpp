#include "misfit/discover/bindings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <string_view>

#include "misfit/core/units.h"
#include "misfit/math/statistics.h"
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

/// Its unit is one per time: rad/s, m/s, kg/s, m^3/s, Hz, but neither m/s^2 nor V.
bool is_rate(const std::string& unit) {
  constexpr std::array<std::string_view, 4> times = {"s", "ms", "min", "h"};
  double power = 0.0;
  for (const auto& [symbol, exponent] : unit_symbols(unit)) {
    if (symbol == "Hz") power -= exponent;
    if (std::find(times.begin(), times.end(), symbol) != times.end()) power += exponent;
  }
  return power == -1.0;
}

/// Roles that the conjugate of a port plays: a state, or a quantity that a declared port calls its rate.
Roles roles_of_conjugate(const SystemSpec& system, const std::string& name) {
  const StateSpec* state = state_called(system, name);
  const auto quantity =
      std::find_if(system.quantities.begin(), system.quantities.end(), [&](const QuantitySpec& q) { return q.name == name; });
  if (state != nullptr && state->rate_of >= 0) {
    const std::string& moved = system.states[state->rate_of].name;
    return {{"rate", name}, {"displacement", moved}, {"level", moved}};
  }
  if (state != nullptr) {
    return {{"level", name}, {is_rate(state->unit) ? "rate" : "content", name}};
  }
  if (quantity == system.quantities.end()) return {};
  if (!quantity->rate_of.empty()) return {{"rate", name}, {"displacement", quantity->rate_of}, {"level", quantity->rate_of}};
  return is_rate(quantity->unit) ? Roles{{"rate", name}} : Roles{};
}

/// It has a default for `signal`: its way of saying that generic effects make sense at places of its own.
bool suggests_places(const SystemSpec& system) { return system.roles.contains("signal"); }

/// Ports on which generic effects make sense by themselves: those of the random force, and those that a system declares.
std::vector<Roles> natural_ports(const SystemSpec& system) {
  std::vector<Roles> out;
  for (const auto& port : system.dynamic_ports) {
    const bool forced = std::find(system.force_ports.begin(), system.force_ports.end(), port.name) != system.force_ports.end();
    const bool declared = port.name != "d" + port.conjugate + "/dt";
    if (port.conjugate.empty() || (!forced && !system.force_ports.empty() && !(declared && suggests_places(system)))) continue;
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
      constexpr std::array<std::string_view, 8> kinds = {"rate", "displacement", "level", "content", "other", "factor", "port", "to_port"};
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

/// Each place whose factor is a state once per other state that may multiply it, each pair once: an input is what sets how strongly a state
/// acts, and so may another state be (a rate constant and a concentration, a damping that depends on the position). Of small systems: among
/// the many products of a larger one there is one that looks like whatever is missing (of the velocities of two masses, a square of their
/// difference).
std::vector<Roles> times_other_states(const std::vector<Roles>& places, const SystemSpec& system) {
  constexpr std::size_t most_states = 3;
  std::vector<Roles> out;
  if (!suggests_places(system) || system.states.size() > most_states) return out;
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

/// What ScanSpec::over says: of which role, and what of it.
struct ScannedSize {
  enum class Kind { range, largest, half_range, nearest_zero, per_step } kind = Kind::range;
  std::string_view role;
};
ScannedSize scanned_size(const ScanSpec& scan) {
  const std::string_view over = scan.over;
  constexpr std::string_view per_step = "|/step";
  if (over.starts_with('|') && over.ends_with(per_step))
    return {ScannedSize::Kind::per_step, over.substr(1, over.size() - 1 - per_step.size())};
  if (over.size() > 2 && over.starts_with('|') && over.ends_with('|')) return {ScannedSize::Kind::largest, over.substr(1, over.size() - 2)};
  if (over.starts_with("+-")) return {ScannedSize::Kind::half_range, over.substr(2)};
  if (over.starts_with("0 ")) return {ScannedSize::Kind::nearest_zero, over.substr(2)};
  return {ScannedSize::Kind::range, over};
}

/// Index of the quantity that ScanSpec::over names, −1 if it names none.
int scanned_quantity(const BoundEffect& effect, const ScanSpec& scan) {
  const std::string_view role = scanned_size(scan).role;
  const auto& quantities = effect.effect->spec().quantities;
  const auto found = std::find_if(quantities.begin(), quantities.end(), [&](const Role& r) { return role == r.name; });
  return found == quantities.end() ? -1 : effect.quantities[found - quantities.begin()];
}

/// What the numbers of a scan are shares of.
double unit_of_scan(const ScannedSize& size, const OperatingRange::Range& range, double step) {
  const double width = range.high - range.low, largest = std::max(std::abs(range.low), std::abs(range.high));
  if (size.kind == ScannedSize::Kind::per_step) return step > 0.0 ? largest / step : largest;
  if (size.kind == ScannedSize::Kind::nearest_zero) return std::clamp(0.0, range.low, range.high);
  if (size.kind == ScannedSize::Kind::half_range) return 0.5 * width;
  return size.kind == ScannedSize::Kind::largest ? largest : width;
}

/// Samples per second where none is missing. Of many samples: times printed with few digits have no exact interval.
double sampling_rate(const std::vector<double>& steps, double usual) {
  constexpr double missing = 1.5;  // usual steps
  double time = 0.0, count = 0.0;
  for (const double h : steps) {
    if (h > missing * usual) continue;
    time += h;
    count += 1.0;
  }
  return count / time;
}

/// Usual sigma of each quantity one step ahead: of g x, x the predicted state with its covariance P and g the quantity's slope.
std::vector<double> sigmas_of_quantities(const FilterEstimate& estimate) {
  constexpr std::size_t samples = 100;  // of each experiment
  const System& system = *estimate.model.system;
  const std::size_t count = system.spec().quantities.size();
  const Eigen::Index states = estimate.model.system_states();
  const std::vector<double> parameters = estimate.forced.model.values(), no_ports(system.spec().quantity_ports.size() + 1, 0.0);
  FilterRunner runner(estimate.forced, false);
  runner.set_parameters(parameters);
  std::vector<std::vector<double>> sigmas(count);
  std::vector<double> q(count);
  RowMatrix slope(static_cast<Eigen::Index>(count), states);
  for (const FilterData& data : estimate.data) {
    FilterTrace trace;
    if (!runner.run(data, estimate.noise, trace, {.keep_P = true})) continue;
    const Eigen::Index n = trace.n, columns = n + 2 * Eigen::Index{trace.ny};
    const std::size_t stride = std::max<std::size_t>((trace.samples - data.first) / samples, 1);
    for (std::size_t k = data.first; k < trace.samples; k += stride) {
      const Point at{trace.predicted_at(k).data(), data.inputs.at(k).values, data.signals->t[k], parameters.data(), no_ports.data()};
      system.linearise_quantities(at, ~std::uint64_t{0}, q.data(), {slope.data(), nullptr, nullptr});
      const Eigen::Map<const RowMatrix> P(trace.P.data() + k * n * columns, n, columns);
      const Eigen::VectorXd variance = (slope * P.topLeftCorner(states, states) * slope.transpose()).diagonal();
      for (std::size_t j = 0; j < count; ++j) sigmas[j].push_back(std::sqrt(std::max(variance[j], 0.0)));
    }
  }
  std::vector<double> out;
  for (auto& list : sigmas) out.push_back(list.empty() ? 0.0 : median(list));
  return out;
}

}  // namespace

bool is_generic(const EffectSpec& effect) {
  return std::any_of(effect.ports.begin(), effect.ports.end(), [](const Role& r) { return r.unit[0] == '*' || r.unit[0] == '{'; });
}

std::vector<Roles> enumerate_bindings(const EffectSpec& effect, const SystemSpec& system) {
  std::vector<Roles> out = {{}};
  if (has_role(effect.ports, all_sample_times) && system.inputs.empty()) return {};
  if (has_role(effect.ports, "time_of_output")) return times_of_outputs(system);
  if (!is_generic(effect)) return out;
  std::vector<Roles> places = {{}};
  if (has_role(effect.ports, "port") || has_role(effect.ports, "to_port")) places = natural_ports(system);
  if (may_be_an_input(effect, "displacement")) places = with_inputs_that_displace(std::move(places), system);
  if (has_role(effect.ports, "to_port")) {
    std::vector<std::string> ports;
    for (const Roles& place : places) ports.push_back(place.at("port"));
    places = times(places, "to_port", ports);
  }
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

OperatingRange::Digits OperatingRange::digits_of(const std::vector<double>& measured) {
  const double step = resolution_of(measured);
  if (!(step > 0.0)) return {};
  constexpr double printed = 1e-3;  // of a step: what is lost of a level where values are printed with few digits
  const double level = std::remainder(measured.front(), step);
  return {step, std::abs(level) < printed * step ? 0.0 : level};
}

OperatingRange::OperatingRange(const FilterEstimate& estimate) : estimate_(estimate) {
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
  for (std::size_t o = count; o < values.size(); ++o) {
    std::erase_if(values[o], [](double v) { return !std::isfinite(v); });
    digits_.push_back(digits_of(values[o]));
  }
  for (auto& list : values) ranges_.push_back(range_of(std::move(list)));
  if (steps.empty()) return;
  const auto middle = steps.begin() + steps.size() / 2;
  std::nth_element(steps.begin(), middle, steps.end());
  step_ = *middle;
  rate_ = sampling_rate(steps, step_);
}

std::optional<OperatingRange::Range> OperatingRange::range(int quantity) const {
  const std::size_t i = quantity;
  return quantity < 0 || i >= ranges_.size() ? std::nullopt : ranges_[i];
}

double OperatingRange::narrowest(int quantity) const {
  if (sigmas_.empty()) sigmas_ = sigmas_of_quantities(estimate_);
  const std::size_t i = quantity;
  return quantity < 0 || i >= sigmas_.size() || !std::isfinite(sigmas_[i]) ? 0.0 : std::sqrt(0.5 * std::numbers::pi) * sigmas_[i];
}

std::optional<OperatingRange::Range> OperatingRange::range_of_edge(const BoundEffect& effect, std::size_t coefficient) const {
  const ScanSpec& scan = effect.effect->spec().coefficients[coefficient].scan;
  return scanned_size(scan).kind == ScannedSize::Kind::range ? range(scanned_quantity(effect, scan)) : std::nullopt;
}

double OperatingRange::lower_bound(const BoundEffect& effect, std::size_t coefficient) const {
  const EffectSpec& spec = effect.effect->spec();
  const CoefficientSpec& c = spec.coefficients[coefficient];
  if (!c.scan.smooths) return c.lower;
  const int quantity = scanned_quantity(effect, c.scan);
  return std::clamp(narrowest(quantity), c.lower, c.upper);
}

std::optional<double> OperatingRange::of_measurements(const BoundEffect& effect, OfMeasurements what) const {
  if (what == OfMeasurements::none || effect.kind != PortKind::sensor) return std::nullopt;
  const std::size_t output = effect.ports.front();
  if (output >= digits_.size() || !(digits_[output].step > 0.0)) return std::nullopt;
  return what == OfMeasurements::step ? digits_[output].step : digits_[output].level;
}

std::vector<double> OperatingRange::grid(const BoundEffect& effect, std::size_t coefficient) const {
  const EffectSpec& spec = effect.effect->spec();
  const CoefficientSpec& c = spec.coefficients[coefficient];
  if (const auto measured = of_measurements(effect, c.measured_as)) return {std::clamp(*measured, c.lower, c.upper)};
  const std::string_view over = c.scan.over;
  const bool of_samples = over == "step" || over == "1/step", size = scanned_size(c.scan).kind != ScannedSize::Kind::range;
  double origin = 0.0, unit = 1.0;
  if (of_samples) {
    unit = over == "step" ? step_ : rate_;
  } else if (!over.empty()) {
    const auto range = this->range(scanned_quantity(effect, c.scan));
    if (!range) return {c.value};
    origin = size ? 0.0 : range->low;
    unit = unit_of_scan(scanned_size(c.scan), *range, step_);
  }
  // A side shape, as the time of following within a limit of a rate, has one value in a larger system: estimated at each of its places it
  // costs minutes.
  constexpr std::size_t small_system = 2;
  const bool large = estimate_.model.system->spec().states.size() > small_system;
  const int count = of_samples && c.fixed && large ? 1 : c.scan.count;
  std::vector<double> out;
  for (int i = 0; i < count; ++i) {
    const int steps = std::max(c.scan.count - 1, 1);
    const double share = size || of_samples ? c.scan.from * std::pow(c.scan.to / c.scan.from, static_cast<double>(i) / steps)
                                            : c.scan.from + (c.scan.to - c.scan.from) * i / steps;
    out.push_back(std::clamp(origin + unit * share, lower_bound(effect, coefficient), c.upper));
  }
  return out;
}

}  // namespace misfit
