#include "apps/init_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "misfit/core/units.h"
#include "misfit/fit/states.h"
#include "misfit/model/role_units.h"

namespace misfit {
namespace {

/// Four significant digits, as a TOML float.
std::string number(double value) {
  std::string text = fmt::format("{:.4g}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string ratio(const std::string& above, const std::string& below) { return bind_unit("{a}/{b}", {{"a", above}, {"b", below}}); }

/// Within a factor of 1000.
std::string positive_bounds(double value) { return fmt::format("bounds = [{}, {}]", number(1e-3 * value), number(1e3 * value)); }

std::string parameter(const std::string& name, const std::string& unit, double value, const std::string& more, const std::string& doc) {
  return fmt::format("{} = {{ unit = \"{}\", value = {}, free = true{}, doc = \"{}\" }}\n", name, unit, number(value),
                     more.empty() ? "" : ", " + more, doc);
}

std::string driven_by(const GuessedModel& model, const GuessedOutput& output) {
  std::string sum;
  for (const auto& input : model.inputs) sum += fmt::format(" + {}_gain_{}*{}", output.name, input, input);
  return sum;
}

std::string rate_name(const GuessedOutput& output) { return output.rate.empty() ? output.name + "_rate" : output.rate; }

std::string parameters_of(const GuessedModel& model, const GuessedOutput& output) {
  const LinearGuess& g = output.guess;
  std::string text = fmt::format("# {}: {}.\n", output.name, g.why);
  if (g.order == 2) {
    text += parameter(output.name + "_stiffness", "1/s^2", g.stiffness, positive_bounds(g.stiffness), "square of the natural frequency");
    text += parameter(output.name + "_damping", "1/s", g.damping, positive_bounds(g.damping), "rate over which the motion slows");
  } else {
    text += parameter(output.name + "_tau", "s", g.tau, positive_bounds(g.tau), "time constant");
  }
  for (std::size_t i = 0; i < model.inputs.size(); ++i) {
    text += parameter(output.name + "_gain_" + model.inputs[i], ratio(output.unit, model.input_units[i]), g.gain[i], "",
                      "static answer to " + model.inputs[i]);
  }
  return text +
         parameter(output.name + "_rest", output.unit, g.rest, "", model.inputs.empty() ? "where it comes to rest" : "answer to no input");
}

std::string equations_of(const GuessedModel& model, const GuessedOutput& output) {
  const std::string target = output.name + "_rest" + driven_by(model, output);
  if (output.guess.order == 1) return fmt::format("{} = \"({} - {})/{}_tau\"\n", output.name, target, output.name, output.name);
  const std::string rate = rate_name(output);
  return fmt::format("{} = \"{}_stiffness*({} - {}) - {}_damping*{}\"   # d{}/dt = {} by rate_of\n", rate, output.name, target, output.name,
                     output.name, rate, output.name, rate);
}

const ColumnSurvey& column_called(const RecordingSurvey& survey, const std::string& name) {
  return *std::find_if(survey.columns.begin(), survey.columns.end(), [&](const ColumnSurvey& c) { return c.name == name; });
}

/// White noise of the readings, at least that of their rounding (Widrow: step/sqrt(12)).
double noise_of(const std::vector<double>& values, double resolution) {
  const double sigma = reading_noise(values);
  const double rounding = resolution / std::sqrt(12.0);
  constexpr double least = 1e-5;  // of the range: smoothed readings seem to have no noise at all
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : values) {
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  }
  return std::max({std::isfinite(sigma) ? sigma : 0.0, rounding, least * (high - low)});
}

}  // namespace

std::string si_unit(const std::string& unit) {
  static const std::map<std::string, std::string> si = {{"mm", "m"},    {"cm", "m"},   {"km", "m"},   {"in", "m"},   {"ft", "m"},
                                                        {"ms", "s"},    {"min", "s"},  {"h", "s"},    {"g", "kg"},   {"lb", "kg"},
                                                        {"deg", "rad"}, {"kN", "N"},   {"lbf", "N"},  {"kPa", "Pa"}, {"hPa", "Pa"},
                                                        {"bar", "Pa"},  {"psf", "Pa"}, {"psi", "Pa"}, {"mV", "V"},   {"%", "-"}};
  std::string out, word;
  const auto flush = [&] {
    const auto found = si.find(word);
    out += found == si.end() ? word : found->second;
    word.clear();
  };
  for (const char c : unit) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%';
    if (letter) {
      word += c;
    } else {
      flush();
      out += c;
    }
  }
  flush();
  return out;
}

GuessedModel guess_model(const RecordingSurvey& survey) {
  GuessedModel model;
  const auto longest =
      std::max_element(survey.parts.begin(), survey.parts.end(), [](const Table& a, const Table& b) { return a.rows() < b.rows(); });
  GuessData data;
  data.t = longest->columns.front().values;
  for (const ColumnSurvey* c : survey.of_use(ColumnUse::input)) {
    model.inputs.push_back(c->name);
    model.input_units.push_back(si_unit(c->unit));
    const bool steps = c->held > 0.2;
    model.hold_reasons.emplace_back(
        steps ? "" : "; what a computer puts out stands until the next sample, \"first_order\" if it was measured between");
    data.inputs.push_back(longest->values(c->name, model.input_units.back()));
  }
  for (const ColumnSurvey* c : survey.of_use(ColumnUse::output)) {
    GuessedOutput output;
    output.name = c->name;
    output.unit = si_unit(c->unit);
    data.y = longest->values(c->name, output.unit);
    output.noise = noise_of(data.y, convert(c->resolution, c->unit, output.unit));
    output.guess = guess_linear(data);
    for (const ColumnSurvey* r : survey.of_use(ColumnUse::rate)) {
      if (r->rate_of != c->name) continue;
      output.rate = r->name;
      output.rate_unit = rate_unit(output.unit);
      output.rate_noise = noise_of(longest->values(r->name, output.rate_unit), convert(r->resolution, r->unit, output.rate_unit));
    }
    model.outputs.push_back(std::move(output));
  }
  return model;
}

std::string model_text(const GuessedModel& model, const RecordingSurvey& survey) {
  std::string text =
      "# A linear model to start from, one equation per state. Names, units and formulas are yours to change: misfit checks that they fit\n"
      "# together. `free = true` is estimated by misfit fit; the values are where it starts.\n"
      "[system]\n"
      "doc = \"linear model, read off the recording by misfit init\"\n"
      "source = \"Ljung, System Identification (1999), 4.2\"\n\n[states]\n";
  for (const auto& o : model.outputs) {
    text += fmt::format("{} = {{ unit = \"{}\", initial = \"free\" }}\n", o.name, o.unit);
    if (o.guess.order == 2)
      text += fmt::format("{} = {{ unit = \"{}\", rate_of = \"{}\", initial = \"free\" }}\n", rate_name(o), rate_unit(o.unit), o.name);
  }
  if (!model.inputs.empty()) text += "\n[inputs]\n";
  for (std::size_t i = 0; i < model.inputs.size(); ++i) {
    text += fmt::format("{} = {{ unit = \"{}\", hold = \"zero_order\" }}   # {}{}\n", model.inputs[i], model.input_units[i],
                        column_called(survey, model.inputs[i]).why, model.hold_reasons[i]);
  }
  text += "\n[parameters]\n";
  for (const auto& o : model.outputs) text += parameters_of(model, o);
  text += "\n[equations]                # what stands on the right is the rate of change of the state\n";
  for (const auto& o : model.outputs) text += equations_of(model, o);
  text += "\n[outputs]                  # what the columns of the data show; noise: white reading noise, a start\n";
  for (const auto& o : model.outputs) {
    text +=
        fmt::format("{} = {{ unit = \"{}\", noise = {} }}   # {}\n", o.name, o.unit, number(o.noise), column_called(survey, o.name).why);
    if (!o.rate.empty() && o.guess.order == 2)
      text += fmt::format("{} = {{ unit = \"{}\", noise = {} }}   # the measured rate of {}\n", o.rate, o.rate_unit, number(o.rate_noise),
                          o.name);
  }
  return text;
}

std::string study_text(const std::string& name, const std::vector<std::string>& parts, const RecordingSurvey& survey) {
  std::string text =
      fmt::format("# Written by misfit init from {}: {}, {} rows, one each {:g} s. Guesses carry their reason: change what is wrong.\n",
                  std::filesystem::path(survey.source).filename().string(), survey.format, survey.rows, survey.step);
  for (const auto& remark : survey.remarks) text += "# Note: " + remark + ".\n";
  text += fmt::format(
      "[study]\n"
      "name = \"{}\"\n"
      "question = \"What does a linear model of this recording miss?\"\n"
      "methods = [\"output_error\"]   # \"filter_error\" where something unmeasured drives the motion; misfit discover needs it\n"
      "seed = 1\n\n"
      "[system]\n"
      "file = \"model.toml\"          # the equations, as text\n",
      name);
  for (const auto& part : parts) {
    text += fmt::format(
        "\n[[experiment]]\n"
        "name = \"{}\"\n"
        "data = \"{}.csv\"\n"
        "validation = \"last 25 %\"     # held out: never seen by the fit; or [t0, t1], or another file\n"
        "# exclude = 5                # initial samples that do not count\n",
        part, part);
  }
  return text + "\n[effects]                    # what the model lacks: `misfit discover` names it, `misfit add` puts it here\n";
}

}  // namespace misfit
