#include "misfit/workflow/init/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "misfit/core/toml_document.h"
#include "misfit/core/toml_text.h"
#include "misfit/core/units.h"
#include "misfit/data/estimators.h"
#include "misfit/model/role_units.h"

namespace misfit {
namespace {

/// Four significant digits, as a TOML float.
std::string number(double value) {
  std::string text = fmt::format("{:.4g}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

/// Within a factor of 1000.
std::string positive_bounds(double value) { return fmt::format("bounds = [{}, {}]", number(1e-3 * value), number(1e3 * value)); }

struct WrittenParameter {
  std::string name, unit;
  double value = 0.0;
  std::string doc;
  bool positive = false;
};

std::string line_of(const WrittenParameter& p) {
  return fmt::format("{} = {{ unit = {}, value = {}, free = true{}, doc = {} }}\n", p.name, toml_string(p.unit), number(p.value),
                     p.positive ? ", " + positive_bounds(p.value) : "", toml_string(p.doc));
}

std::string driven_by(const GuessedModel& model, const GuessedOutput& output) {
  std::string sum = output.rest;
  if (output.from_zero) sum = model.zero->name + " + " + sum;
  for (const auto& gain : output.gains)
    sum +=
        gain.from_zero ? fmt::format(" + {}*({} - {})", gain.name, gain.of, model.zero->name) : fmt::format(" + {}*{}", gain.name, gain.of);
  return sum;
}

std::string parameters_of(const GuessedOutput& output) {
  const LinearGuess& g = output.guess;
  std::string text = fmt::format("# {}: {}.\n", output.name, g.why);
  if (!output.stiffness.empty())
    text += line_of(
        {.name = output.stiffness, .unit = "1/s^2", .value = g.stiffness, .doc = "square of the natural frequency", .positive = true});
  if (!output.damping.empty()) {
    const char* doc = g.integrates ? "1/time constant of the rate" : "twice the damping ratio times the natural frequency";
    text += line_of({.name = output.damping, .unit = "1/s", .value = g.damping, .doc = doc, .positive = true});
  }
  if (!output.tau.empty()) text += line_of({.name = output.tau, .unit = "s", .value = g.tau, .doc = "time constant", .positive = true});
  for (const auto& gain : output.gains) text += line_of({.name = gain.name, .unit = gain.unit, .value = gain.value, .doc = gain.doc});
  return text + line_of({.name = output.rest, .unit = output.rest_unit, .value = output.rest_value, .doc = output.rest_doc});
}

std::string equations_of(const GuessedModel& model, const GuessedOutput& output) {
  const std::string target = driven_by(model, output);
  const bool pulled = !output.guess.integrates;
  if (output.guess.order == 1) {
    if (!pulled) return fmt::format("{} = \"{}\"\n", output.name, target);
    return fmt::format("{} = \"({} - {})/{}\"\n", output.name, target, output.name, output.tau);
  }
  const std::string driven = pulled ? fmt::format("{}*({} - {})", output.stiffness, target, output.name) : target;
  return fmt::format("{} = \"{} - {}*{}\"   # d{}/dt = {} by rate_of\n", output.rate_state, driven, output.damping, output.rate_state,
                     output.name, output.rate_state);
}

/// What the comment behind a column says, with its header where that is not simply its name.
std::string remark_on(const ColumnSurvey& column) {
  return toml_comment(column.header.starts_with(column.name) ? column.why : "'" + column.header + "': " + column.why);
}

bool in_model(const ColumnSurvey& column) {
  return column.use == ColumnUse::input || column.use == ColumnUse::output || column.use == ColumnUse::rate;
}

/// Of every SI unit the one in which all columns of it were recorded, where that is another.
std::vector<std::string> recorded_units(const RecordingSurvey& survey) {
  std::map<std::string, std::set<std::string>> recorded;
  for (const ColumnSurvey& column : survey.columns) {
    if (in_model(column)) recorded[unit_in_si(column.unit)].insert(plain_unit(column.unit));
  }
  std::vector<std::string> out;
  for (const auto& [si, units] : recorded) {
    if (units.size() > 1 || si == *units.begin() || si == "s" || si == "rad") continue;
    const auto symbols = unit_symbols(*units.begin());
    if (std::any_of(symbols.begin(), symbols.end(), [](const auto& symbol) { return symbol.first == "deg"; })) continue;
    out.push_back(*units.begin());
  }
  return out;
}

/// Results are shown as what was recorded: in degrees where a column is, else in radians, and in units that are not SI. Empty where there
/// is nothing to say.
std::string display_of(const RecordingSurvey& survey) {
  bool angles = false, degrees = false;
  for (const ColumnSurvey& column : survey.columns) {
    if (!in_model(column)) continue;
    for (const auto& [symbol, power] : unit_symbols(column.unit)) {
      degrees = degrees || symbol == "deg";
      angles = angles || parse_unit(symbol).angle;
    }
  }
  const std::vector<std::string> units = recorded_units(survey);
  std::string text;
  if (angles && !degrees) text += "angle = \"rad\"              # as recorded; or \"deg\"\n";
  if (!units.empty()) text += fmt::format("units = {}   # as recorded; the formulas below are in SI\n", toml_texts(units));
  return text.empty() ? "" : "[display]\n" + text + "\n";
}

}  // namespace

std::string model_text(const GuessedModel& model, const RecordingSurvey& survey) {
  std::string text =
      "# A linear model to start from, one equation per state. Names, units and formulas are yours to change: misfit checks that they fit\n"
      "# together. `free = true` is estimated by misfit fit; the values are where it starts.\n"
      "[system]\n"
      "doc = \"linear model, estimated from the recording by misfit init\"\n"
      "source = \"Ljung, System Identification (1999), 4.2\"\n\n" +
      display_of(survey) + "[states]\n";
  for (const auto& o : model.outputs) {
    text += fmt::format("{} = {{ unit = {}, initial = \"free\" }}\n", o.name, toml_string(o.unit));
    if (o.guess.order == 2)
      text +=
          fmt::format("{} = {{ unit = {}, rate_of = \"{}\", initial = \"free\" }}\n", o.rate_state, toml_string(rate_unit(o.unit)), o.name);
  }
  if (!model.inputs.empty()) text += "\n[inputs]\n";
  for (std::size_t i = 0; i < model.inputs.size(); ++i) {
    text += fmt::format("{} = {{ unit = {}, hold = \"{}\" }}   # {}{}\n", model.inputs[i], toml_string(model.input_units[i]),
                        model.holds[i], remark_on(column_called(survey, model.inputs[i])), model.hold_reasons[i]);
  }
  text += "\n[parameters]\n";
  if (model.zero)
    text += fmt::format("{} = {{ unit = \"K\", value = {:.6g}, doc = {} }}\n", model.zero->name, model.zero->value,
                        toml_string("0 " + model.zero->unit + ": levels are counted from there"));
  for (const auto& o : model.outputs) text += parameters_of(o);
  text += "\n[equations]                # right-hand side: rate of change of the state\n";
  for (const auto& o : model.outputs) text += equations_of(model, o);
  text += "\n[outputs]                  # the measured columns; noise: sigma of the white measurement noise, a start\n";
  for (const auto& o : model.outputs) {
    text += fmt::format("{} = {{ unit = {}, noise = {} }}   # {}\n", o.name, toml_string(o.unit), number(o.noise),
                        remark_on(column_called(survey, o.name)));
    if (!o.rate.empty() && o.guess.order == 2)
      text += fmt::format("{} = {{ unit = {}, noise = {} }}   # the measured rate of {}\n", o.rate, toml_string(o.rate_unit),
                          number(o.rate_noise), o.name);
  }
  return text;
}

std::string study_text(const std::string& name, const std::vector<std::string>& parts, const RecordingSurvey& survey) {
  std::string text = fmt::format(
      "# Written by misfit init from {}: {}, {} rows, one sample every {:g} s. Guesses carry their reason: change what is wrong.\n",
      toml_comment(std::filesystem::path(survey.source).filename().string()), survey.format, survey.rows, survey.step);
  for (const auto& remark : survey.remarks) text += "# Note: " + toml_comment(remark) + ".\n";
  text += fmt::format(
      "[study]\n"
      "name = {}\n"
      "question = \"What does the linear model of this recording lack?\"\n"
      "methods = [\"{}\"]   # with a random force beside the model: it shows where the model fails; \"{}\": without\n"
      "seed = 1\n\n"
      "[system]\n"
      "file = \"model.toml\"          # the equations, as text\n",
      toml_string(name), random_force_estimator().name, trajectory_estimator().name);
  for (const auto& part : parts) {
    text += fmt::format(
        "\n[[experiment]]\n"
        "name = {}\n"
        "data = {}\n"
        "validation = \"last 25 %\"     # held out: never seen by the fit; or [t0, t1], or another file\n"
        "# exclude = 5                # initial samples that do not count\n",
        toml_string(part), toml_string(part + ".csv"));
  }
  return text +
         "\n[effects]                    # what the model lacks: `misfit discover` names it; `misfit add` writes a new study, a rung, and "
         "leaves this one\n";
}

}  // namespace misfit
