#pragma once

// Systems and effects given as text, for tests.

#include <string>

#include "misfit/model/declared.h"
#include "misfit/model/declared_effect.h"
#include "tests/model/requests.h"

namespace misfit::testing_models {

inline const std::string duffing_text = R"toml(
[states]
y = { unit = "V", scale = 0.1 }
v = { unit = "V/s", scale = 4.0 }
[inputs]
u = { unit = "V" }
[parameters]
stiffness = { unit = "1/s^2", value = 30.0, bounds = [0.0, 1e4], free = true }
damping = { unit = "1/s", value = 0.4, bounds = [0.0, 1e3], free = true }
cubic = { unit = "1/V^2/s^2", value = 50.0, free = true }
gain = { unit = "1/s^2", value = 10.0 }
[quantities]
spring = { unit = "V/s^2", formula = "stiffness*y + cubic*y^3" }
[ports]
push = { unit = "V/s^2" }
[equations]
y = "v"
v = "gain*u - damping*v - spring + push"
[outputs]
y = { unit = "V", noise = 1e-3 }
)toml";

/// A registry over that of the tests with one more system, of the name `key`.
inline std::shared_ptr<Registry> registry_with(const std::string& text, const std::string& key = "text") {
  auto own = std::make_shared<Registry>(Registry::over(registry()));
  own->add(declared_system(text, key + ".toml", key));
  return own;
}

inline ModelRequest request_of(const std::string& system, const std::vector<EffectRequest>& effects = {}) {
  ModelRequest r;
  r.system = system;
  r.effects = effects;
  return r;
}

/// An effect declared in one line of a study: the text behind NAME =.
inline EffectStudy effect_in_one_line(const std::string& name, const std::string& line) {
  const config::Section root = config::Section::parse("[effects]\n" + name + " = " + line + "\n", "study.toml");
  const config::Section section = *root.table("effects")->table(name);
  EffectStudy study;
  study.name = study.kind = name;
  study.where = {"study.toml", 2, 1};
  study.declared = FormulaStudy{*section.text("formula"), *section.text("port"), section.where_text("formula"),
                                section.texts("strengths").value_or(std::vector<std::string>{}), section.table("parameters")};
  return study;
}

}  // namespace misfit::testing_models
