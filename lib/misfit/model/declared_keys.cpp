#include "misfit/model/declared_keys.h"

#include "misfit/data/estimators.h"
#include "misfit/data/study_keys.h"

namespace misfit::declared {
namespace {

using config::Key;
using config::KeyGroup;
using Type = config::KeyType;

Key unit_key() { return {.name = "unit", .otherwise = "required", .meaning = "SI, as \"m/s\"; \"-\" if it has none."}; }
Key doc_key() { return {.name = "doc", .fallback = "\"\"", .meaning = "What it is."}; }

// A key is a line of attributes and a line of meaning.
// clang-format off
KeyGroup system_group() {
  return {"system",
     "What the system is. Formulas: + - * / ^ ( ), names of states, inputs, parameters, quantities and ports, t, and functions; units are "
     "checked through them (SI, radians).",
     {{.name = "doc", .fallback = "\"declared system\"", .meaning = "One line on the system."},
      {.name = "source", .fallback = "\"\"", .meaning = "Where the equations come from."},
      {.name = "fastest_rate", .type = Type::number, .unit = "1/s", .otherwise = "from the equations", .least = 0.0,
       .above = true,
       .meaning = "Integration steps are at most 0.5/fastest_rate long. Not needed: steps follow the fastest rate of the equations and an "
                  "estimate of their error, implicit where stiff, and are checked at the estimate (integration in fit.json)."}}};
}

KeyGroup display_group() {
  return {"display", "How results are shown; what is read has units of its own.",
     {{.name = "angle", .type = Type::choice, .fallback = "\"deg\"", .choices = {"deg", "rad"},
       .meaning = "Angles and their rates: deg, deg/s, deg/s^2, or rad, rad/s, rad/s^2; knots without a unit are in it, too."},
      {.name = "units", .type = Type::texts, .otherwise = "SI",
       .meaning = "Units in which states, inputs, outputs, quantities and parameters of their kind are shown, as [\"rpm\", \"degC\", \"kW\"], "
                  "and parameters made of them: what is in K/W, in K/kW; errors and differences of temperatures in K. Knots without a unit are "
                  "in them, too, those of temperatures in K. What is [1] is shown in % only if it is no parameter."}}};
}

std::vector<KeyGroup> state_groups() {
  return {{"states.NAME", "A state of the system; at least one is needed.",
       {unit_key(),
        {.name = "initial", .type = Type::other, .unit = "of the state", .otherwise = "\"free\"",
         .form = R"("free", "shared", number or table)",
         .meaning = "At the first sample. free: estimated in every experiment; shared: one value for all; a number: fixed."},
        {.name = "min", .type = Type::number, .unit = "of the state", .otherwise = "none",
         .meaning = "No integration step leaves the state below it."},
        {.name = "max", .type = Type::number, .unit = "of the state", .otherwise = "none",
         .meaning = "No integration step leaves the state above it."},
        {.name = "scale", .type = Type::number, .unit = "of the state", .otherwise = "size of the initial value, else 1", .least = 0.0,
         .above = true,
         .meaning = "Typical size: how uncertain the state is before anything is measured."},
        {.name = "rate_of", .otherwise = "none",
         .meaning = "State whose time derivative this one is; its equation may then be left out."}}},
      {"states.NAME.initial", "The initial value in full.",
       {{.name = "kind", .type = Type::choice, .fallback = "\"free\"", .choices = {"free", "shared", "fixed"}, .meaning = "As above."},
        {.name = "value", .type = Type::number, .unit = "of the state", .otherwise = "none; required where it is fixed",
         .meaning = "Start of the estimation, or the value where it is fixed."}}}};
}

KeyGroup input_group() {
  return {"inputs.NAME", "A measured input.",
     {unit_key(),
      {.name = "hold", .type = Type::choice, .fallback = "\"first_order\"", .choices = hold_names(),
       .meaning = "Between samples: constant, a straight line, or a smooth curve through them (cubic spline), as of a signal without content "
                  "near half the sampling rate."},
      {.name = "delay", .type = Type::number, .unit = "s", .fallback = "0", .least = 0.0,
       .meaning = "Known dead time; one to be estimated is the effect delay."},
      doc_key()}};
}

std::vector<KeyGroup> formula_groups() {
  const Key formula{.name = "formula", .otherwise = "required", .meaning = "In quotation marks."};
  return {{"quantities.NAME", "A named function of states, inputs and parameters that effects may read; it is a quantity port as well.",
       {unit_key(), formula, doc_key()}},
      {"ports.NAME", "A place for effects inside formulas: 0 without effects. Every equation also has the port dSTATE/dt.",
       {unit_key(),
        {.name = "rate", .otherwise = "role rate", .meaning = "Quantity whose product with the port is power."},
        doc_key()}},
      {"equations", "The time derivative of every state.",
       {{.name = "STATE", .otherwise = "required, but for a state that has a rate_of it", .any = true,
         .meaning = "Formula in quotation marks, as \"-k*sqrt(x) + g*u\"."}}},
      {"outputs.NAME", "A measured output; at least one is needed.",
       {unit_key(),
        {.name = "formula", .otherwise = "the state of that name", .meaning = "In quotation marks."},
        {.name = "noise", .type = Type::number, .unit = "of the output", .otherwise = "1",
         .meaning = "Standard deviation of the measurement noise from which its estimation starts where the data show none."}}}};
}

KeyGroup role_group() {
  return {"roles", "What generic effects act on where a study does not say it.",
     {{.name = "rate", .otherwise = "rate of port, else the first state with rate_of, else the first",
       .meaning = "Quantity: rate of the motion (friction)."},
      {.name = "level", .otherwise = "the state whose rate it is", .meaning = "Quantity: displacement or level."},
      {.name = "content", .otherwise = "that of rate, if it is the rate of nothing", .meaning = "Quantity: what its port fills, for a leak."},
      {.name = "port", .otherwise = "the first of [ports], else of force_ports, else of the equations", .meaning = "Dynamic port."},
      {.name = "input", .otherwise = "the first input", .meaning = "Input or quantity."},
      {.name = "output", .otherwise = "the first output", .meaning = "Output that sensor effects change."},
      {.name = "force_ports", .type = Type::texts, .otherwise = "equations of motion, else all equations",
       .meaning = std::string("Dynamic ports of the random force that ") + random_force_estimator().name + " estimates."}}};
}

// clang-format on

std::vector<KeyGroup> all_groups() {
  std::vector<KeyGroup> out{system_group(), display_group()};
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
