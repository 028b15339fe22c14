// The study of a new rung: the text of the one below with one line changed.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "misfit/core/error.h"
#include "misfit/core/units.h"
#include "misfit/data/study_edit.h"
#include "misfit/model/provisional.h"
#include "misfit/workflow/ladder.h"

namespace misfit {
namespace {

bool same_effect(const EffectRequest& a, const std::string& kind, const std::map<std::string, std::string>& roles) {
  return a.kind == kind && a.roles == roles;
}

std::string listed(const std::vector<EffectRequest>& effects) {
  std::string out;
  for (const auto& effect : effects) out += (out.empty() ? "" : ", ") + effect.name;
  return out;
}

/// A name that no effect of the model has: the kind, or kind_2, ….
std::string free_name(const std::vector<EffectRequest>& effects, const std::string& kind) {
  std::string name = kind;
  const auto taken = [&] { return std::any_of(effects.begin(), effects.end(), [&](const EffectRequest& e) { return e.name == name; }); };
  for (int number = 2; taken(); ++number) name = kind + "_" + std::to_string(number);
  return name;
}

double least_distance(const std::vector<double>& rising) {
  double out = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < rising.size(); ++i) out = std::min(out, rising[i] - rising[i - 1]);
  return out;
}

/// The study's text with the knots of a curve of unknown form where discovery found it [SI]; in the unit that is shown, to a hundredth of
/// the distance of two.
std::string with_knots(const std::string& text, const Curve& curve, const std::vector<double>& knots) {
  const double shown = convert_difference(1.0, curve.of_unit, display_unit(curve.of_unit)), apart = shown * least_distance(knots);
  const int digits = std::clamp(2 - static_cast<int>(std::floor(std::log10(apart))), 0, std::numeric_limits<double>::max_digits10);
  std::string list;
  for (const double knot : knots) list += fmt::format("{}{:.{}f}", list.empty() ? "" : ", ", shown * knot, digits);
  return with_value(with_value(text, {"curves", curve.name, "of"}, fmt::format("\"{}\"", curve.of)), {"curves", curve.name, "knots"},
                    "[" + list + "]");
}

/// Where to start: shapes where discovery's scan found most (from a wrong sector or frequency no refit finds the right one), and if it
/// refitted the effect, all its numbers at that maximum (another start may end in a lower one).
EffectStart start_found(const Effect& effect, const Candidate& from) {
  EffectStart start{{}, from.free, from.fixed};
  for (const auto& c : effect.spec().coefficients) {
    const bool scanned_shape = c.scan.is_scanned() && c.kind == CoefficientKind::shape;
    if (c.shared || c.over_sine || (!scanned_shape && !from.actual_drop)) continue;  // over a sine: a curve, discovery's number is C/sin
    for (const auto& [name, estimate] : from.parameters) {
      if (name == c.name || name.ends_with(std::string(".") + c.name)) start.values[c.name] = estimate.value;
    }
  }
  return start;
}

/// The study's text with these parameters of the model fixed at these values.
std::string with_fixed(std::string text, const Session& session, const ModelRequest& model, const std::map<std::string, Estimate>& fixed) {
  const std::map<std::string, std::string> names = parameter_names(model, session.registry);
  for (const auto& [name, estimate] : fixed) {
    std::vector<std::string> path = parameter_path(text, name_in_study(session.study, names, name));
    const auto set = [&](const char* key, const std::string& value) {
      path.emplace_back(key);
      text = with_value(text, path, value);
      path.pop_back();
    };
    set("value", fmt::format("{}", estimate.value));
    set("free", "false");
  }
  return text;
}

/// The name that a coefficient has in a system → the name the same one has in another.
std::map<std::string, std::string> renamed_coefficients(const SystemSpec& from, const SystemSpec& to) {
  std::map<std::string, std::string> out;
  for (const auto& [own, name] : from.coefficient_names) {
    const auto there = to.coefficient_names.find(own);
    out[name] = there == to.coefficient_names.end() ? own : there->second;
  }
  for (const auto& [own, name] : to.coefficient_names) {
    if (!from.coefficient_names.contains(own)) out[own] = name;
  }
  return out;
}

/// The model with another system and neither parameters nor curves: their names may be others there.
ModelRequest with_system_only(const ModelRequest& model, const std::string& kind, const SystemOptions& options, const SystemType& type) {
  ModelRequest with = model;
  with.system = kind;
  with.options = options;
  with.constants.clear();  // the new system may ask for others; assemble() of the new study says so
  const SystemSpec spec = type.make(options)->spec();
  for (const auto& constant : spec.constants) {
    const auto given = model.constants.find(constant.name);
    with.constants[constant.name] = given != model.constants.end() ? given->second : std::max(constant.value, constant.lower);
  }
  with.parameters.clear();
  with.curves.clear();
  return with;
}

/// Names of effects that cannot be assembled into the model.
std::vector<std::string> unsuited_effects(const Session& session, const ModelRequest& model) {
  std::vector<std::string> names;
  for (const auto& effect : model.effects) {
    const auto& coefficients = session.registry.effect(effect.kind).spec().coefficients;
    if (std::any_of(coefficients.begin(), coefficients.end(), [](const CoefficientSpec& c) { return c.shared; }) &&
        model.effects.size() > 1)
      continue;  // it needs the others, and is judged with them when the new study is read
    ModelRequest alone = model;
    alone.effects = {effect};
    try {
      std::ignore = provisional_model(std::move(alone), session.registry);
    } catch (const InputError&) {
      names.push_back(effect.name);
    }
  }
  return names;
}

/// An edit that is refused names the study.
template <class Edit>
std::string edited(const Session& session, const Edit& edit) {
  try {
    return edit();
  } catch (const InputError& error) {
    throw InputError({session.study.file.string(), 0, 0}, error.what());
  }
}

}  // namespace

std::string study_with_effect(const Session& session, const std::string& effect, const std::optional<Candidate>& from,
                              const std::filesystem::path& folder) {
  const ModelRequest& model = session.model.request;
  const Effect& found = session.registry.effect(effect);  // InputError with the nearest name
  const std::map<std::string, std::string> roles = from ? from->roles : std::map<std::string, std::string>{};
  for (const auto& own : model.effects) {
    if (same_effect(own, effect, roles))
      throw InputError("effect '" + effect + "' is already in the model (" + listed(model.effects) + ")");
  }
  const std::string name = free_name(model.effects, effect);
  ModelRequest with = model;
  with.effects.push_back({name, effect, roles, {}});
  const auto assembled = [&] {
    try {
      return provisional_model(with, session.registry);
    } catch (const InputError& error) {
      throw InputError("effect '" + effect + "' does not suit this model: " + error.what());
    }
  }();
  const auto start = from ? start_found(found, *from) : EffectStart{};
  const std::string text = text_for_folder(session.study, folder);
  return edited(session, [&] {
    std::string added = with_effect(text, effect_line(name, effect, roles, start));
    if (from && from->knots.size() > 1) added = with_knots(added, assembled.curves.back(), from->knots);
    return from ? with_fixed(added, session, with, from->fixed_in_model) : added;
  });
}

std::string study_with_system(const Session& session, const std::string& kind, const std::filesystem::path& folder,
                              std::vector<std::string>& left_out) {
  const ModelRequest& model = session.model.request;
  if (kind == model.system) throw InputError("the model's system is already '" + kind + "'");
  const SystemType& type = session.registry.system(kind);  // InputError with the nearest name
  std::string text = text_for_folder(session.study, folder);
  const auto edit = [&](const auto& change) { text = edited(session, change); };
  edit([&] { return with_system(text, kind); });
  SystemOptions options;
  for (const auto& [flag, value] : model.options.flags) {
    if (std::find(type.flags.begin(), type.flags.end(), flag) != type.flags.end()) {
      options.flags[flag] = value;
    } else {
      edit([&, name = flag] { return without_entry(text, "system", name, "of " + model.system); });
    }
  }
  for (const std::string& effect : unsuited_effects(session, with_system_only(model, kind, options, type))) {
    left_out.push_back(effect);
    edit([&] { return without_entry(text, "effects", effect, "does not suit " + kind); });
  }
  const SystemSpec from = session.registry.system(model.system).make(model.options)->spec();
  for (const auto& [old_name, new_name] : renamed_coefficients(from, type.make(options)->spec())) {
    for (const char* section : {"curves", "parameters"})
      edit([&, from_name = old_name, to_name = new_name] { return with_renamed_entry(text, section, from_name, to_name); });
  }
  return text;
}

}  // namespace misfit
