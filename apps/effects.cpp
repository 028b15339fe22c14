#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/verbs.h"
#include "misfit/core/text.h"
#include "misfit/model/declared.h"

namespace misfit {
namespace {

std::string joined(const std::vector<Role>& roles) {
  std::string out;
  for (const auto& role : roles) out += fmt::format("{}{}{} [{}]", out.empty() ? "" : ", ", role.name, role.optional ? "?" : "", role.unit);
  return out.empty() ? "none" : out;
}

std::string coefficients_of(const EffectSpec& spec) {
  std::string out;
  for (const auto& c : spec.coefficients) {
    if (c.borrowed) {
      out += fmt::format("{}{} [{}] of another effect", out.empty() ? "" : "; ", c.name, c.unit);
      continue;
    }
    out += fmt::format("{}{} [{}] {} in [{:g}, {:g}]{}", out.empty() ? "" : "; ", c.name, c.unit,
                       c.kind == CoefficientKind::strength ? "strength" : "shape", c.lower, c.upper,
                       c.curve_of[0] == '\0' ? "" : fmt::format(", a curve of {}", c.curve_of));
  }
  return out.empty() ? "none" : out;
}

std::string states_of(const EffectSpec& spec) {
  std::string out;
  for (const auto& s : spec.states) out += fmt::format("{}{} [{}]", out.empty() ? "" : ", ", s.name, s.unit);
  return out.empty() ? "none" : out;
}

/// Names as the study calls them, or every effect the program knows.
std::vector<std::string> chosen(const std::optional<Study>& study, const Registry& registry) {
  if (!study) return registry.effect_keys();
  std::vector<std::string> keys;
  for (const auto& effect : study->effects) keys.push_back(registry.effect(effect.kind, effect.where).spec().key);
  return keys;
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
                                    {"kind", c.borrowed                            ? "borrowed"
                                             : c.kind == CoefficientKind::strength ? "strength"
                                                                                   : "shape"},
                                    {"bounds", {c.lower, c.upper}},
                                    {"start", c.value},
                                    {"doc", c.doc},
                                    {"curve_of", c.curve_of}});
  }
  return json;
}

}  // namespace

int effects_verb(const Options& options, const Registry& registry) {
  std::optional<Study> study;
  if (!options.session.study.empty()) study = read_study(options.session.study);
  const auto declared = study ? study_registry(*study, registry) : nullptr;
  const Registry& known = study ? *declared : registry;
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const auto& key : chosen(study, known)) {
    const EffectSpec& spec = known.effect(key).spec();
    if (options.json) {
      all.push_back(as_json(spec));
      continue;
    }
    std::cout << key << '\n';
    for (const auto& [what, text] : std::vector<std::pair<std::string, std::string>>{{"formula", spec.formula},
                                                                                     {"symbols", spec.symbols},
                                                                                     {"roles", joined(spec.quantities)},
                                                                                     {"ports", joined(spec.ports)},
                                                                                     {"coefficients", coefficients_of(spec)},
                                                                                     {"own states", states_of(spec)},
                                                                                     {"valid", spec.valid},
                                                                                     {"size", spec.size},
                                                                                     {"source", spec.source},
                                                                                     {"not", spec.excludes}}) {
      if (text != "none") std::cout << fmt::format("  {:<13} {}\n", what, text);
    }
    std::cout << '\n';
  }
  if (options.json) std::cout << all.dump(1) << '\n';
  return 0;
}

}  // namespace misfit
