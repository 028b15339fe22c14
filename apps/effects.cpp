#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/help.h"
#include "apps/verbs.h"
#include "misfit/core/shell_word.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/data/study_edit.h"
#include "misfit/model/declared.h"

namespace misfit {
namespace {

std::string joined(const std::vector<Role>& roles) {
  std::string out;
  for (const auto& role : roles) out += fmt::format("{}{}{} [{}]", out.empty() ? "" : ", ", role.name, role.optional ? "?" : "", role.unit);
  return out.empty() ? "none" : out;
}

/// "a curve of alpha_T", "a curve of what its role `of` names"; "": a number.
std::string curve_in_words(const EffectSpec& spec, const CoefficientSpec& c) {
  if (c.curve_of[0] == '\0') return "";
  return spec.curve_role(c) < 0 ? fmt::format("a curve of {}", c.curve_of) : fmt::format("a curve of what its role `{}` names", c.curve_of);
}

std::string coefficients_of(const EffectSpec& spec) {
  std::string out;
  for (const auto& c : spec.coefficients) {
    if (c.shared) {
      out += fmt::format("{}{} [{}] of another effect", out.empty() ? "" : "; ", c.name, c.unit);
      continue;
    }
    out += fmt::format("{}{} [{}] {} in [{:g}, {:g}]{}", out.empty() ? "" : "; ", c.name, c.unit,
                       c.kind == CoefficientKind::strength ? "strength" : "shape", c.lower, c.upper,
                       c.curve_of[0] == '\0' ? "" : ", " + curve_in_words(spec, c));
  }
  return out.empty() ? "none" : out;
}

std::string states_of(const EffectSpec& spec) {
  std::string out;
  for (const auto& s : spec.states) out += fmt::format("{}{} [{}]", out.empty() ? "" : ", ", s.name, s.unit);
  return out.empty() ? "none" : out;
}

nlohmann::ordered_json as_json(const EffectSpec& spec) {
  nlohmann::ordered_json json{
      {"effect", spec.key},          {"formula", spec.formula},  {"symbols", spec.symbols}, {"roles", joined(spec.quantities)},
      {"ports", joined(spec.ports)}, {"valid", spec.valid},      {"size", spec.size},       {"source", spec.source},
      {"not", spec.excludes},        {"states", states_of(spec)}};
  json["constants"] = spec.constants;
  json["coefficients"] = nlohmann::ordered_json::array();
  for (const auto& c : spec.coefficients) {
    json["coefficients"].push_back({{"name", c.name},
                                    {"unit", c.unit},
                                    {"kind", c.shared                              ? "shared"
                                             : c.kind == CoefficientKind::strength ? "strength"
                                                                                   : "shape"},
                                    {"bounds", {c.lower, c.upper}},
                                    {"start", c.value},
                                    {"doc", c.doc},
                                    {"curve_of", c.curve_of}});
  }
  return json;
}

/// "name  text" with further lines below the text.
std::string entry(const std::string& name, const std::string& text, std::size_t width = 100) {
  constexpr std::size_t column = 18;
  const std::string lines = wrap_text(text, width, std::string(column, ' '));
  return "  " + name + lines.substr(name.size() + 2) + "\n";
}

using Texts = std::vector<std::pair<std::string, std::string>>;

std::string short_text(const EffectSpec& spec) {
  std::string out = spec.key + "\n";
  for (const auto& [what, text] : Texts{{"formula", spec.formula},
                                        {"symbols", spec.symbols},
                                        {"roles", joined(spec.quantities)},
                                        {"ports", joined(spec.ports)},
                                        {"coefficients", coefficients_of(spec)},
                                        {"own states", states_of(spec)},
                                        {"valid", spec.valid},
                                        {"size", spec.size},
                                        {"source", spec.source},
                                        {"does not cover", spec.excludes}}) {
    if (text != "none") out += fmt::format("  {:<14} {}\n", what, text);
  }
  return out + "\n";
}

std::string parameters_table(const EffectSpec& spec) {
  std::vector<std::vector<std::string>> rows{{"parameter", "unit", "kind", "default", "bounds", "meaning"}};
  for (const auto& c : spec.coefficients) {
    const std::string kind = c.shared ? "of another effect" : c.kind == CoefficientKind::strength ? "strength" : "shape";
    const std::string meaning = c.curve_of[0] == '\0' ? c.doc : fmt::format("{}; {}", c.doc, curve_in_words(spec, c));
    rows.push_back({c.name, c.unit, kind, c.shared ? "" : fmt::format("{:g}{}", c.value, c.fixed ? ", fixed" : ""),
                    c.shared ? "" : fmt::format("[{:g}, {:g}]", c.lower, c.upper), meaning});
  }
  return rows.size() > 1 ? "\n" + align_columns(rows) + "\n" : "";
}

/// How a study adds it. Roles of any unit are what a study most often binds.
std::string study_line(const EffectSpec& spec) {
  std::string roles;
  for (const auto* list : {&spec.quantities, &spec.ports}) {
    for (const Role& role : *list)
      if (!role.optional) roles += fmt::format("{}{} = \"NAME\"", roles.empty() ? "" : ", ", role.name);
  }
  const std::string line = effect_line(spec.key, spec.key, {});
  const std::string bound = fmt::format("{} = {{ {} }}", spec.key, roles);
  std::string out = spec.has_unknown_form() ? fmt::format("  in a study\n    [effects]\n    {}\n", bound)
                                            : fmt::format("  in a study\n    [effects]\n    {}\n    # to act elsewhere: {}\n", line, bound);
  const auto own = std::find_if(spec.coefficients.begin(), spec.coefficients.end(), [](const CoefficientSpec& c) { return !c.shared; });
  if (own != spec.coefficients.end()) {
    out += fmt::format(
        "    # another start: {0} = {{ start = {{ {1} = {2:g} }} }}\n    # free, fixed, bounds, prior: [parameters] {1} = {{ … }}, "
        "see misfit help study\n",
        spec.key, own->name, own->value);
  }
  return out;
}

std::string full_text(const EffectSpec& spec) {
  std::string constants;
  for (const auto& name : spec.constants) constants += (constants.empty() ? "" : ", ") + name;
  std::string out = spec.key + "\n";
  const auto add = [&](const Texts& texts) {
    for (const auto& [what, text] : texts)
      if (!text.empty() && text != "none") out += entry(what, text);
  };
  add({{"formula", spec.formula}, {"symbols", spec.symbols}, {"reads", joined(spec.quantities)}, {"adds to", joined(spec.ports)}});
  add({{"constants", constants}, {"own states", states_of(spec)}});
  out += parameters_table(spec);
  add({{"valid", spec.valid}, {"size", spec.size}, {"source", spec.source}, {"does not cover", spec.excludes}});
  return out + study_line(spec);
}

/// The effects that the words on the command line name: those of a study, one of them, or one of the program.
struct Chosen {
  std::shared_ptr<const Registry> declared;  ///< owns what the study declares
  std::vector<const EffectSpec*> effects;
  bool in_full = false;
};

Chosen of_study(const Options& options, const Registry& registry) {
  const Study study = read_study(options.session.study);
  Chosen out{study_registry(study, registry), {}, !options.effect.empty()};
  std::vector<std::string> names;
  for (const EffectStudy& effect : study.effects) {
    names.push_back(effect.name);
    const EffectSpec& spec = out.declared->effect(effect.kind, effect.where).spec();
    if (!out.in_full || options.effect == effect.name) out.effects.push_back(&spec);
  }
  if (out.in_full && out.effects.empty())
    throw InputError("the study has no effect '" + shown(options.effect) + "'" + suggest(options.effect, names));
  return out;
}

Chosen chosen(const Options& options, const Registry& registry) {
  std::error_code error;
  const std::string& what = options.session.study;
  const bool is_path = what.find('/') != std::string::npos || what.ends_with(".toml") || std::filesystem::exists(what, error);
  const std::vector<std::string> keys = registry.effect_keys();
  const bool is_key = std::find(keys.begin(), keys.end(), what) != keys.end();
  if (!what.empty() && is_path && !is_key) return of_study(options, registry);
  Chosen out;
  if (!what.empty()) return {nullptr, {&registry.effect(what).spec()}, true};
  for (const auto& key : keys) out.effects.push_back(&registry.effect(key).spec());
  return out;
}

}  // namespace

int effects_verb(const Options& options, const Registry& registry) {
  if (options.session.study.empty() && !options.json && !options.verbose) {
    std::cout << help_text("effects", registry);
    return 0;
  }
  const Chosen known = chosen(options, registry);
  if (known.effects.empty() && !options.json) {
    const std::string study = shell_word(options.session.study);
    std::cout << fmt::format(
        "{0} has no effects yet: misfit discover {0} tests which of the library it is missing; misfit help effects lists those\n", study);
  }
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const EffectSpec* spec : known.effects) {
    if (options.json) {
      all.push_back(as_json(*spec));
    } else {
      std::cout << (known.in_full ? full_text(*spec) : short_text(*spec));
    }
  }
  if (options.json) std::cout << all.dump(1) << '\n';
  return 0;
}

}  // namespace misfit
