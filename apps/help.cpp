#include "apps/help.h"

#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/text.h"
#include "misfit/data/estimators.h"
#include "misfit/data/study_keys.h"
#include "misfit/formula/syntax.h"
#include "misfit/model/declared_keys.h"
#include "misfit/show/glossary.h"

namespace misfit {
namespace {

constexpr std::size_t columns = 100;

std::string paragraph(const std::string& text, const std::string& indent = "") { return wrap_text(text, columns, indent) + "\n"; }

std::string systems_text(const Registry& registry) {
  std::string out = "Systems of this program: kind, options and constants for [geometry]\n\n";
  for (const std::string& key : registry.system_keys()) {
    const SystemType& type = registry.system(key);
    const auto system = type.make({});
    out += key + "\n" + paragraph(system->spec().doc, "  ");
    if (!type.flags.empty()) out += paragraph(fmt::format("options: {}", fmt::join(type.flags, ", ")), "  ");
    std::vector<std::vector<std::string>> rows{{"constant", "unit", "default", "meaning"}};
    for (const ConstantSpec& c : system->spec().constants)
      rows.push_back({c.name, c.unit, c.required ? "required" : fmt::format("{:g}", c.value), c.doc});
    if (rows.size() > 1) out += align_columns(rows, "    ");
    out += "\n";
  }
  return out;
}

std::string study_text(const Registry& registry) {
  return paragraph(
             "study.toml is TOML. Numbers are in SI, angles in radians, or texts with a unit: 0.6, \"24 in\", \"3 deg/s\" (\"0.6\" is "
             "0.6). Files are taken "
             "from "
             "the folder of the study. Keys in capitals stand for names that you choose or that the model has. An unknown key is an "
             "error.") +
         "\n" + config::key_reference(study_keys(), columns) + systems_text(registry);
}

std::string system_text() {
  return paragraph(
             "A system declared as text (TOML), named by [system] file of a study. misfit init writes one for a recording; "
             "models/*.toml are examples.") +
         "\n" + config::key_reference(declared::system_keys(), columns) +
         paragraph(
             "Formulas: + - * / ^, comparisons (<, <=, >, >=, ==), and, or, not; pi; t, the time [s]; sqrt(x), exp(x), "
             "log(x), log10(x), sin(x) and its kin, atan2(y, x), hypot(x, y), pow(x, n); abs(x), sign(x), min(a, b), max(a, "
             "b), saturate(x, low, high); if(condition, a, b); smooth_step(x, w) = (1 + tanh(x/w))/2. abs, sign, min, max "
             "and saturate take a width w as a last argument, in the unit of x, over which the kink or the jump is rounded: "
             "what jumps has no derivative by a level inside it, so that a level that is to be estimated needs a width. A "
             "bare number has no unit: declare others as parameters. What recurs every day between two hours is "
             "if(cos(2*pi*(t - noon)/day) > edge, x - y, 0*x), with parameters that are not free: day = { unit = \"s\", "
             "value = 86400, free = false }, noon the middle of the window [s], and edge 0.98 for 1.5 h, 0.92 for 3 h, 0.71 "
             "for 6 h.") +
         paragraph(fmt::format("Names that formulas reserve: {}.", fmt::join(formula::reserved_names(), ", ")));
}

std::string effects_text(const Registry& registry) {
  std::string out = "Effects of this program (misfit effects KEY: one in full; misfit effects --verbose: all):\n\n";
  std::size_t width = 0;
  for (const std::string& key : registry.effect_keys()) width = std::max(width, key.size());
  for (const std::string& key : registry.effect_keys()) {
    const std::string lines = wrap_text(registry.effect(key).spec().formula, columns, std::string(width + 4, ' '));
    out += "  " + key + lines.substr(key.size() + 2) + "\n";
  }
  return out;
}

/// Methods, as their table describes them, and words of the parachutes of the examples.
Glossary words_of_examples() {
  Glossary out;
  for (const EstimatorInfo* method : estimators::all) out.emplace_back(method->name, method->doc);
  out.insert(
      out.end(),
      {{"C_m_alphadot, C_mq", "derivatives of the pitching moment by the rate of the angle of attack, and by the pitch rate"},
       {"coning", "motion of an axis around a cone: a steady angle of attack that turns about the direction of flight"},
       {"spherical system", "a body on a pivot that is free to swing in both directions, unlike the planar one, which swings in a plane"}});
  return out;
}

std::string words_text() {
  std::string out;
  const auto add = [&out](const Glossary& terms) {
    for (const auto& [word, meaning] : terms) {
      constexpr std::size_t column = 19;
      const std::string lines = wrap_text(meaning, columns, std::string(column, ' ')), term = "  " + std::string(word);
      out += (term.size() < column ? term + lines.substr(term.size()) : term + "\n" + lines) + "\n";
    }
  };
  add(main_glossary());
  out += "\n";
  add(further_glossary());
  out += "\n";
  add(words_of_examples());
  return out;
}

std::string data_text() {
  const std::vector<std::pair<const char*, const char*>> formats = {
      {"CSV",
       "columns under a line of names with units, t[s],u[V],w[rad/s]; commas, semicolons, tabs or blanks; dates as a time "
       "(by misfit init, which writes seconds; [[experiment]] data wants a number)"},
      {"MAT", "MATLAB 5 to 7.3: arrays of numbers, also in structs (s.w) and cells (c{1})"},
      {"HDF5", "arrays and tables of numbers (run1/w); units from the attribute \"units\""},
      {"NPY, NPZ", "NumPy: arrays, records, datetime64"},
      {"ULog", "PX4's .ulg: topic.field, topic[1].field of a second instance"},
      {"DataFlash", "ArduPilot's .bin: IMU[0].GyrX; units from the log"}};
  std::string out =
      paragraph("Recordings that misfit init and [[experiment]] data of a study read, recognised by their first bytes:") + "\n";
  for (const auto& [name, meaning] : formats) {
    const std::string lines = wrap_text(meaning, columns, std::string(13, ' '));
    out += "  " + (name + lines.substr(2 + std::string(name).size()));
    out += "\n";
  }
  return out + "\n" +
         paragraph(
             "A matrix is a channel per column: x[0], x[1]. The time of an array is the array t, time or timestamp beside it with the "
             "same number of values. Where sensors have clocks of their own there is a row for every time of any of them, so that every "
             "measurement stands at its own time (with columns = { t = ... }: at the nearest of those times); inputs are held or "
             "interpolated as the model says. Notes say what was done and what was left out.") +
         "\n" +
         paragraph(
             "misfit init LOG lists the channels of a log of several clocks; then say which: --topic TOPIC, or --output CHANNEL and "
             "--input CHANNEL. In a study:") +
         "\n  [[experiment]]\n  data = \"flight.ulg\"\n"
         "  columns = { w = \"vehicle_angular_velocity.xyz[0]\", u = \"actuator_controls_0.control[0]\" }\n\n" +
         paragraph(
             "A recording is split where rows are missing for so long that an input of the model may have changed meanwhile "
             "(three times the step that 98 % of the steps do not exceed), and at gaps that are longer than 10 sampling intervals and "
             "also longer than about 8 periods (50 rad) of the fastest motion: its parts, NAME_part_1 and so on, have initial states of "
             "their own. The model runs across other gaps.") +
         "\n" +
         paragraph(
             "Units: SI and their kin, as us, ns, min, rpm, degC, \xC2\xB0, kW, mA, bar, km/h. An unknown unit of time is an "
             "error; any other unknown unit is reported, and its numbers are taken as they are. Excel and Parquet files are not read: save "
             "them as CSV.");
}

}  // namespace

const std::vector<std::pair<std::string, std::string>>& help_topics() {
  static const std::vector<std::pair<std::string, std::string>> topics = {
      {"study", "every key of study.toml: type, unit, default, meaning; systems and their constants"},
      {"system", "every key of a system declared as text"},
      {"effects", "the effects, one line each"},
      {"data", "the formats of recordings, channels, clocks and units"},
      {"words", "the words that misfit uses in a sense of its own"}};
  return topics;
}

std::string help_text(const std::string& topic, const Registry& registry) {
  if (topic == "study") return study_text(registry);
  if (topic == "system") return system_text();
  if (topic == "effects") return effects_text(registry);
  if (topic == "data") return data_text();
  return words_text();
}

}  // namespace misfit
