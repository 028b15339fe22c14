#include "misfit/model/request.h"

#include <algorithm>
#include <array>

#include "misfit/core/lists.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/data/study_keys.h"
#include "misfit/model/experiment.h"

namespace misfit {
namespace {

constexpr std::array<RigEntry, 9> entries = {{{"R", &RigGeometry::R},
                                              {"R_cp", &RigGeometry::R_cp},
                                              {"V", &RigGeometry::V},
                                              {"l_b", &RigGeometry::l_b},
                                              {"l_s", &RigGeometry::l_s},
                                              {"l_p", &RigGeometry::l_p},
                                              {"R1", &RigGeometry::R1},
                                              {"R2", &RigGeometry::R2},
                                              {"R3", &RigGeometry::R3}}};

/// Limits are those of a rig that a camera looks at. A constant of the system that has the name of an entry and another dimension is none.
void read_rig(const config::Section& section, const SystemSpec& spec, bool camera, RigGeometry& rig) {
  const config::DescribedSection geometry(section, config::group_of(study_keys(), "geometry"));
  for (const auto& entry : entries) {
    const std::string& unit = geometry.description().key(entry.name).unit;
    const int own = index_of(spec.constants, entry.name);
    if (own >= 0 && !parse_unit(spec.constants[own].unit).same_dimension(parse_unit(unit))) continue;
    const auto number = camera ? geometry.number(entry.name) : section.number(entry.name, unit, true);
    if (number) rig.*entry.field = number->value;
  }
}

void read_constants(const config::Section& geometry, const SystemSpec& spec, ModelRequest& request) {
  for (const auto& constant : spec.constants) {
    const auto number = geometry.number(constant.name, constant.unit, true);
    if (!number) continue;
    request.constants[constant.name] = number->value;
    request.constants_where[constant.name] = number->where;
    if (number->sigma) request.constant_sigmas[constant.name] = *number->sigma;
  }
}

ParameterRequest read_parameter(const ParameterStudy& study, const std::string& unit) {
  ParameterRequest out;
  out.where = study.where;
  out.free = study.free;
  if (!study.section) return out;
  const config::DescribedSection section(*study.section, config::group_of(study_keys(), "parameters.NAME"));
  out.value = section.value("value", unit);
  out.sigma = section.value("sigma", unit);
  if (const auto bounds = section.numbers("bounds", unit)) {
    if (bounds->size() != 2) section.fail("bounds", "must be [lower, upper]");
    out.lower = bounds->front();
    out.upper = bounds->back();
  }
  section.finish();
  return out;
}

using Words = std::map<std::string, std::string>;

/// The model's name of what a study may call otherwise; a name that the model does not have is reported by assemble().
std::string name_in_model(const Words& names, const std::string& name) {
  const auto known = names.find(name);
  return known == names.end() ? name : known->second;
}

/// … and of a parameter of an effect, as its line calls it.
std::string name_in_model(const Words& names, const EffectStudy& effect, const std::string& own) {
  const auto known = names.find(effect.name + "." + own);
  return known == names.end() ? own : known->second;
}

void read_parameters(const Study& study, const Words& units, const Words& names, ModelRequest& request) {
  for (const auto& [name, parameter] : study.parameters) {
    const auto unit = units.find(name);
    const std::string in_model = name_in_model(names, name);
    const ParameterRequest read = read_parameter(parameter, unit == units.end() ? "-" : unit->second);
    if (!request.parameters.emplace(in_model, read).second)
      throw InputError(parameter.where, "[parameters]: '" + shown(name) + "' stands there under another name, too: the model calls it '" +
                                            shown(in_model) + "'");
  }
}

/// `start`, `free` and `fixed` of an effect's line: what [parameters] does not say.
void read_starts(const Study& study, const Words& units, const Words& names, ModelRequest& request) {
  for (const auto& effect : study.effects) {
    for (const auto& [own, number] : effect.start) {
      const std::string name = name_in_model(names, effect, own);
      const auto unit = units.find(name);
      if (unit != units.end() && !number.unit.empty() && !parse_unit(number.unit).same_dimension(parse_unit(unit->second)))
        throw InputError(number.where, name + " needs [" + plain_si(unit->second) + "], not [" + number.unit + "]");
      ParameterRequest& parameter = request.parameters[name];
      if (parameter.where.file.empty()) parameter.where = number.where;
      if (!parameter.value) parameter.value = number.value;
    }
    for (const auto& [list, is_free] : {std::pair{&effect.free, true}, std::pair{&effect.fixed, false}}) {
      for (const std::string& own : *list) {
        if (is_free && std::find(effect.fixed.begin(), effect.fixed.end(), own) != effect.fixed.end())
          throw InputError(effect.where, "effect '" + shown(effect.name) + "': " + shown(own) + " stands in free and in fixed");
        ParameterRequest& parameter = request.parameters[name_in_model(names, effect, own)];
        if (parameter.where.file.empty()) parameter.where = effect.where;
        if (!parameter.free) parameter.free = is_free;
      }
    }
  }
}

void read_initial(const Study& study, const SystemSpec& spec, ModelRequest& request) {
  for (const auto& [name, initial] : study.initial) {
    ModelRequest::InitialRequest& out = request.initial[name];
    out.where = initial.where;
    if (!initial.kind.empty())
      out.initial = initial.kind == "fixed" ? Initial::fixed : initial.kind == "shared" ? Initial::shared : Initial::free;
    if (!initial.value) continue;
    out.value = initial.value->value;
    for (const auto& state : spec.states) {
      const bool unlike =
          state.name == name && !initial.value->unit.empty() && !parse_unit(initial.value->unit).same_dimension(parse_unit(state.unit));
      if (unlike)
        throw InputError(initial.where, "[initial] " + name + " needs [" + plain_si(state.unit) + "], not [" + initial.value->unit + "]");
    }
  }
}

/// Units of the ports that the random force may act on, each once.
std::vector<std::string> force_units(const SystemSpec& spec) {
  std::vector<std::string> out;
  for (const PortSpec& port : spec.dynamic_ports) {
    const auto& named = spec.force_ports;
    const bool forced = named.empty() || std::find(named.begin(), named.end(), port.name) != named.end();
    const auto alike = [&](const std::string& unit) { return parse_unit(unit).same_dimension(parse_unit(port.unit)); };
    if (forced && std::none_of(out.begin(), out.end(), alike)) out.push_back(plain_si(port.unit));
  }
  return out;
}

void read_force(const Study& study, const SystemSpec& spec, ModelRequest& request) {
  request.force_time = study.force_time;
  if (!study.force_strength) return;
  const config::Number& strength = *study.force_strength;
  const std::vector<std::string> units = force_units(spec);
  const auto alike = [&](const std::string& unit) { return parse_unit(unit).same_dimension(parse_unit(strength.unit)); };
  const bool known = strength.unit.empty() ? units.size() == 1 : std::any_of(units.begin(), units.end(), alike);
  if (!known) {
    throw InputError(strength.where, "[force] strength needs the unit of a port that the random force acts on (" + join_words(units) + ")" +
                                         (strength.unit.empty() ? "" : ", not [" + strength.unit + "]"));
  }
  request.force_strength = KnownForce{strength.value, *strength.sigma, strength.unit};
}

void read_noise(const Study& study, const SystemSpec& spec, ModelRequest& request) {
  for (const auto& [name, noise] : study.noise) {
    request.noise[name] = {noise.sigma.value, noise.fixed, noise.where, noise.frequency.value_or(0.0)};
    for (const auto& output : spec.outputs) {
      const bool unlike =
          output.name == name && !noise.sigma.unit.empty() && !parse_unit(noise.sigma.unit).same_dimension(parse_unit(output.unit));
      if (unlike)
        throw InputError(noise.where, "[noise] " + name + " needs [" + plain_si(output.unit) + "], not [" + noise.sigma.unit + "]");
    }
  }
}

/// Of a quantity or output; empty if the system has neither of that name.
std::string unit_of(const SystemSpec& spec, const std::string& quantity) {
  for (const auto& q : spec.quantities) {
    if (q.name == quantity) return q.unit;
  }
  for (const auto& o : spec.outputs) {
    if (o.name == quantity) return o.unit;
  }
  return "";
}

/// Knots without a unit are in the unit that is shown: degrees of an angle, but where [display] of the system says rad.
void read_curves(const Study& study, const SystemSpec& spec, ModelRequest& request) {
  for (const auto& [name, curve] : study.curves) {
    CurveRequest out{curve.of, {}, curve.roughness, curve.where};
    const std::string unit = unit_of(spec, curve.of);
    const double bare = unit.empty() ? 1.0 : convert_difference(1.0, display_unit(unit), unit);
    for (const config::Number& knot : curve.knots.value_or(std::vector<config::Number>{})) {
      if (!unit.empty() && !knot.unit.empty() && !parse_unit(knot.unit).same_dimension(parse_unit(unit)))
        throw InputError(knot.where, "[curves] " + name + ": knots need [" + plain_si(unit) + "], not [" + knot.unit + "]");
      out.knots.push_back(knot.unit.empty() ? bare * knot.value : knot.value);
    }
    request.curves[name] = out;
  }
}

/// Does some system that comes with the program, with its flags as they are or one set otherwise, have this signal? A ladder may go on with
/// another system and the same recordings.
bool is_known_signal(const std::string& name, const Registry& registry) {
  for (const std::string& key : registry.system_keys()) {
    const SystemType& type = registry.system(key);
    std::vector<SystemOptions> options(1);
    for (const std::string& flag : type.flags) {
      for (const bool value : {false, true}) options.push_back({{{flag, value}}, {}});
    }
    for (const SystemOptions& o : options) {
      const std::vector<std::string> names = signal_names(type.make(o)->spec());
      if (std::find(names.begin(), names.end(), name) != names.end()) return true;
    }
  }
  return false;
}

/// Names that nothing would ask a recording for; those of a track are checked with the study.
void check_columns(const Study& study, const std::string& system, const SystemSpec& spec, const Registry& registry) {
  const std::vector<std::string> valid = signal_names(spec);
  for (const ExperimentStudy& experiment : study.experiments) {
    if (!experiment.data || !experiment.columns_section) continue;
    for (const auto& [name, header] : experiment.columns.header_of) {
      const bool own = std::find(valid.begin(), valid.end(), name) != valid.end();
      if (own || (!study.system_file && is_known_signal(name, registry))) continue;
      experiment.columns_section->fail(name, "system '" + shown(system) + "' has no such signal" + suggest(name, valid));
    }
  }
}

}  // namespace

std::span<const RigEntry> rig_entries() { return entries; }

StudyModel read_model(const Study& study, const Registry& registry) {
  StudyModel out;
  ModelRequest& request = out.request;
  if (study.system_kind.empty() && !study.system_file)
    throw InputError({study.file.string(), 0, 0}, "[system] kind is missing" + suggest("", registry.system_keys()));
  request.system = study.system_file ? study.system_file->stem().string() : study.system_kind;
  request.options.flags = study.system_flags;
  for (const auto& [name, number] : study.system_numbers) request.options.numbers[name] = number.value;
  const auto where = study.system_where.find(study.system_file ? "file" : "kind");
  request.system_where = where == study.system_where.end() ? Source{study.file.string(), 0, 0} : where->second;
  const SystemType& type = registry.system(request.system, request.system_where);
  for (const auto& [name, number] : study.system_numbers) {
    throw InputError(number.where,
                     "system '" + shown(request.system) + "' has no option '" + shown(name) + "'" + suggest(name, type.flags));
  }
  const SystemSpec spec = type.make(request.options)->spec();
  check_columns(study, request.system, spec, registry);
  if (study.geometry) {
    read_rig(*study.geometry, spec, study.has_camera, out.rig);
    read_constants(*study.geometry, spec, request);
    study.geometry->finish();
  }
  for (const auto& effect : study.effects) request.effects.push_back({effect.name, effect.kind, effect.roles, effect.where});
  const Words units = parameter_units(request, registry), names = parameter_names(request, registry);
  read_parameters(study, units, names, request);
  read_starts(study, units, names, request);
  read_initial(study, spec, request);
  read_noise(study, spec, request);
  read_force(study, spec, request);
  read_curves(study, spec, request);
  return out;
}

namespace {

/// The key of `all` that stands for it; its own name where none does.
template <class Map>
std::string key_for(const Map& all, const Words& names, const std::string& own) {
  const std::string wanted = name_in_model(names, own);
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& entry) { return name_in_model(names, entry.first) == wanted; });
  return found == all.end() ? own : found->first;
}

}  // namespace

std::string name_in_study(const Study& study, const Words& names, const std::string& parameter) {
  return key_for(study.parameters, names, parameter);
}

std::string curve_in_study(const Study& study, const Words& names, const std::string& curve) { return key_for(study.curves, names, curve); }

std::optional<ModelRequest> regression_form(const ModelRequest& request, const Registry& registry, std::vector<std::string>& left_out) {
  const SystemSpec own = registry.system(request.system, request.system_where).make(request.options)->spec();
  if (own.regression.kind.empty()) return std::nullopt;
  ModelRequest form = request;
  form.system = own.regression.kind;
  form.options = {own.regression.flags, {}};
  const SystemSpec spec = registry.system(form.system).make(form.options)->spec();
  form.parameters.clear();
  form.noise.clear();
  form.curves.clear();
  std::erase_if(form.effects, [&](const EffectRequest& effect) {
    const auto& coefficients = registry.effect(effect.kind, effect.where).spec().coefficients;
    const bool known = std::all_of(coefficients.begin(), coefficients.end(), [&](const CoefficientSpec& c) {
      if (c.shared) return true;
      const auto renamed = spec.coefficient_names.find(c.name);
      const std::string name = renamed == spec.coefficient_names.end() ? c.name : renamed->second;
      return name == spec.static_curve || name == spec.damping_curve;
    });
    if (!known) left_out.push_back(effect.name);
    return !known;
  });
  return form;
}

void require_rig(const Study& study, const RigGeometry& rig, bool for_sweep) {
  std::vector<std::string> missing;
  for (const auto& entry : entries) {
    const std::string name = entry.name;
    const bool of_sweep = name == "l_p" || name == "R1" || name == "R2" || name == "R3";
    if ((for_sweep || !of_sweep) && !(rig.*entry.field > 0.0)) missing.push_back(name);
  }
  if (missing.empty()) return;
  std::string list;
  for (const auto& name : missing) list += (list.empty() ? "" : ", ") + name;
  throw InputError({study.file.string(), 0, 0},
                   "[geometry] lacks " + list + ", which the " + (for_sweep ? "calibration" : "camera") + " needs");
}

}  // namespace misfit
