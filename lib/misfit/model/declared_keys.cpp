#include "misfit/model/declared_keys.h"

#include "misfit/data/study_keys.h"

namespace misfit::declared {
namespace {

using config::Key;
using config::KeyGroup;
using Type = config::KeyType;

Key unit_key() { return {.name = "unit", .meaning = "SI, as \"m/s\"; \"-\" if it has none.", .otherwise = "required"}; }
Key doc_key() { return {.name = "doc", .meaning = "What it is.", .fallback = "\"\""}; }

KeyGroup system_group() {
  return {
      "system",
      "What the system is. Formulas: + - * / ^ ( ), names of states, inputs, parameters, quantities and ports, t, and functions; units are "
      "checked through them (SI, radians).",
      {{.name = "doc", .meaning = "One line on the system.", .fallback = "\"declared system\""},
       {.name = "source", .meaning = "Where the equations come from.", .fallback = "\"\""},
       {.name = "fastest_rate",
        .type = Type::number,
        .meaning = "Lower bound of the fastest rate, which sets the integration step: rate times step at most 0.5.",
        .unit = "1/s",
        .otherwise = "from the Jacobian of the equations alone",
        .least = 0.0,
        .above = true}}};
}

std::vector<KeyGroup> state_groups() {
  return {{"states.NAME",
           "A state of the system; at least one is needed.",
           {unit_key(),
            {.name = "initial",
             .type = Type::other,
             .meaning = "At the first sample. free: estimated in every experiment; shared: one value for all; a number: fixed.",
             .unit = "of the state",
             .otherwise = "\"free\"",
             .form = R"("free", "shared", number or table)"},
            {.name = "min",
             .type = Type::number,
             .meaning = "No integration step leaves the state below it.",
             .unit = "of the state",
             .otherwise = "none"},
            {.name = "max",
             .type = Type::number,
             .meaning = "No integration step leaves the state above it.",
             .unit = "of the state",
             .otherwise = "none"},
            {.name = "scale",
             .type = Type::number,
             .meaning = "Typical size: how uncertain the state is before anything is measured.",
             .unit = "of the state",
             .otherwise = "size of the initial value, else 1",
             .least = 0.0,
             .above = true},
            {.name = "rate_of",
             .meaning = "State whose time derivative this one is; its equation may then be left out.",
             .otherwise = "none"}}},
          {"states.NAME.initial",
           "The initial value in full.",
           {{.name = "kind", .type = Type::choice, .meaning = "As above.", .fallback = "\"free\"", .choices = {"free", "shared", "fixed"}},
            {.name = "value",
             .type = Type::number,
             .meaning = "Start of the estimation, or the value where it is fixed.",
             .unit = "of the state",
             .otherwise = "none; required where it is fixed"}}}};
}

KeyGroup input_group() {
  return {"inputs.NAME",
          "A measured input.",
          {unit_key(),
           {.name = "hold",
            .type = Type::choice,
            .meaning = "Between samples: constant, or a straight line.",
            .fallback = "\"first_order\"",
            .choices = {"zero_order", "first_order"}},
           {.name = "delay",
            .type = Type::number,
            .meaning = "Known dead time; one to be estimated is the effect delay.",
            .unit = "s",
            .fallback = "0",
            .least = 0.0},
           doc_key()}};
}

std::vector<KeyGroup> formula_groups() {
  const Key formula{.name = "formula", .meaning = "In quotation marks.", .otherwise = "required"};
  return {
      {"quantities.NAME",
       "A named function of states, inputs and parameters that effects may read; it is a quantity port as well.",
       {unit_key(), formula, doc_key()}},
      {"ports.NAME",
       "A place for effects inside formulas: 0 without effects. Every equation also has the port dSTATE/dt.",
       {unit_key(), {.name = "rate", .meaning = "Quantity whose product with the port is power.", .otherwise = "role rate"}, doc_key()}},
      {"equations",
       "The time derivative of every state.",
       {{.name = "STATE",
         .meaning = "Formula in quotation marks, as \"-k*sqrt(x) + g*u\".",
         .otherwise = "required, but for a state that has a rate_of it",
         .any = true}}},
      {"outputs.NAME",
       "A measured output; at least one is needed.",
       {unit_key(),
        {.name = "formula", .meaning = "In quotation marks.", .otherwise = "the state of that name"},
        {.name = "noise",
         .type = Type::number,
         .meaning = "Standard deviation of the measurement noise from which its estimation starts where the data show none.",
         .unit = "of the output",
         .otherwise = "1"}}}};
}

KeyGroup role_group() {
  return {"roles",
          "What generic effects act on where a study does not say it.",
          {{.name = "rate",
            .meaning = "Quantity: rate of the motion (friction).",
            .otherwise = "rate of port, else the first state with rate_of"},
           {.name = "level", .meaning = "Quantity: displacement or level.", .otherwise = "the state whose rate it is"},
           {.name = "port", .meaning = "Dynamic port.", .otherwise = "the first of [ports], else of force_ports, else of the equations"},
           {.name = "input", .meaning = "Input or quantity.", .otherwise = "the first input"},
           {.name = "output", .meaning = "Output that sensor effects change.", .otherwise = "the first output"},
           {.name = "force_ports",
            .type = Type::texts,
            .meaning = "Dynamic ports of the random force that filter_error estimates.",
            .otherwise = "equations of motion, else all equations"}}};
}

std::vector<KeyGroup> all_groups() {
  std::vector<KeyGroup> out{system_group()};
  const auto add = [&](const std::vector<KeyGroup>& groups) { out.insert(out.end(), groups.begin(), groups.end()); };
  add(state_groups());
  add({input_group(), {"parameters.NAME", "A constant of the system.", declared_parameter_keys(false)}});
  add(formula_groups());
  add({role_group()});
  return out;
}

}  // namespace

std::span<const KeyGroup> system_keys() {
  static const std::vector<KeyGroup> groups = all_groups();
  return groups;
}

config::DescribedSection described(const config::Section& section, std::string_view key, std::string_view path) {
  const auto table = section.table(key);
  return {table ? *table : config::Section::parse("", section.file().string()), config::group_of(system_keys(), path)};
}

}  // namespace misfit::declared
