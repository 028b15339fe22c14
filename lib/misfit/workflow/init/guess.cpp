#include "misfit/workflow/init/guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "misfit/core/error.h"
#include "misfit/core/lists.h"
#include "misfit/core/text.h"
#include "misfit/core/unique_name.h"
#include "misfit/core/units.h"
#include "misfit/data/held_out_change.h"
#include "misfit/fit/regression/lost_sign.h"
#include "misfit/formula/syntax.h"
#include "misfit/inference/states.h"
#include "misfit/model/role_units.h"
#include "misfit/recording/column_facts.h"

namespace misfit {
namespace {

/// White noise of the measurements, at least that of their rounding (Widrow: step/sqrt(12)), in `unit`.
double noise_of(const std::vector<double>& values, const ColumnSurvey& column, const std::string& unit) {
  const double sigma = measurement_noise(values);
  const double rounding = convert_difference(column.resolution, column.unit, unit) / std::sqrt(12.0);
  constexpr double least = 1e-5;  // of the range: smoothed measurements seem to have no noise at all
  return std::max({std::isfinite(sigma) ? sigma : 0.0, rounding, least * convert_difference(column.high - column.low, column.unit, unit)});
}

double largest(const ColumnSurvey& column, const std::string& unit) {
  return convert(std::max(std::abs(column.low), std::abs(column.high)), column.unit, unit);
}

/// Sums of squares of what is measured must be numbers.
void refuse_extremes(const RecordingSurvey& survey) {
  constexpr double most = 1e100, least = 1e-100;
  for (const auto& c : survey.columns) {
    const bool used = c.use == ColumnUse::time || c.use == ColumnUse::input || c.use == ColumnUse::output || c.use == ColumnUse::rate;
    if (!used || (largest(c, c.unit) < most && c.high - c.low > least)) continue;
    throw InputError({survey.source, 0, 0},
                     fmt::format("column '{}' runs from {} to {}: the squares of such numbers cannot be computed with; give it in "
                                 "another unit, so that it is between 1e-100 and 1e100",
                                 c.header, format_value(c.low), format_value(c.high)));
  }
}

/// What a first model still takes.
struct Room {
  int states = most_guessed.states, outputs = most_guessed.outputs, parameters = most_guessed.parameters;

  bool take(const GuessedOutput& output) {
    const bool oscillatory = output.guess.order == 2;
    const int of_states = oscillatory ? 2 : 1, of_outputs = oscillatory && !output.rate.empty() ? 2 : 1;
    const int of_parameters = (oscillatory ? 3 : 2) + int_size(output.gains);
    if (of_states > states || of_outputs > outputs || of_parameters > parameters) return false;
    states -= of_states;
    outputs -= of_outputs;
    parameters -= of_parameters;
    return true;
  }
};

void note_left_out(const char* what, const std::vector<std::string>& names, const std::string& limit, std::vector<std::string>& remarks) {
  if (names.empty()) return;
  constexpr std::size_t shown = 6;
  const std::size_t more = names.size() - std::min(names.size(), shown);
  remarks.push_back(fmt::format("not in the model: {} {}{}; {}", what,
                                fmt::join(names.begin(), names.begin() + (names.size() - more), ", "),
                                more > 0 ? fmt::format(" and {} more", more) : "", limit));
}

/// Names for what the equation of an output needs, each unlike all others.
void name_parts(std::set<std::string>& taken, GuessedOutput& output) {
  const auto part = [&](const std::string& end) { return unique_name(output.name + end, taken); };
  const bool second = output.guess.order == 2, pulled = !output.guess.integrates;
  if (second) {
    output.rate_state = output.rate.empty() ? part("_rate") : output.rate;
    output.damping = part("_damping");
  }
  if (pulled) (second ? output.stiffness : output.tau) = part(second ? "_stiffness" : "_tau");
  for (auto& gain : output.gains) gain.name = part("_gain_" + gain.of);
  output.rest = part(pulled ? "_rest" : "_offset");
}

struct ReasonedHold {
  const char *hold, *reason;
};

/// What it is between its samples.
ReasonedHold hold_of(const ColumnSurvey& input, const std::vector<double>& values) {
  if (input.is_measured_input)
    return {"first_order", is_smooth(values) ? "; it varies smoothly, so straight between samples"
                                             : "; taken as measured, so straight between samples, \"zero_order\" if it is a command"};
  if (jumps(values)) return {"zero_order", input.repeat_share > 0.2 ? "" : "; it jumps, so it is held until the next sample"};
  return {"zero_order", input.repeat_share > 0.2
                            ? ""
                            : "; a computer's output is held until the next sample, \"first_order\" if it was measured between"};
}

void guess_inputs(const RecordingSurvey& survey, const Table& table, GuessedModel& model, GuessData& data) {
  std::vector<std::string> left_out;
  for (const ColumnSurvey* c : survey.of_use(ColumnUse::input)) {
    if (std::ssize(model.inputs) == most_guessed.inputs) {
      left_out.push_back(c->name);
      continue;
    }
    model.inputs.push_back(c->name);
    model.input_units.push_back(unit_in_si(c->unit));
    GuessDriver driver{
        .values = table.values(c->name, model.input_units.back()), .smooth = c->is_measured_input, .named = c->chosen_by_user};
    const auto& [hold, reason] = hold_of(*c, driver.values);
    model.holds.emplace_back(hold);
    model.hold_reasons.emplace_back(reason);
    data.drivers.push_back(std::move(driver));
  }
  note_left_out("inputs", left_out, fmt::format("a first model has at most {} inputs", most_guessed.inputs), model.remarks);
}

/// A measured column and what the model says of it.
struct Candidate {
  const ColumnSurvey* column;
  std::vector<double> values;  ///< SI
};

/// In a unit such as degC, whose 0 is not that of SI.
bool has_offset(const ColumnSurvey& column) { return parse_unit(column.unit).offset != 0.0; }

/// Of the first column in the model that is in such a unit.
std::optional<UnitZero> unit_zero(const RecordingSurvey& survey, std::set<std::string>& taken) {
  for (const ColumnUse use : {ColumnUse::output, ColumnUse::input}) {
    for (const ColumnSurvey* c : survey.of_use(use)) {
      if (has_offset(*c))
        return UnitZero{unique_name("zero_" + plain_unit(c->unit), taken), plain_unit(c->unit), parse_unit(c->unit).offset};
    }
  }
  return std::nullopt;
}

/// Counts levels from the zero of such units.
void count_from_zero(const RecordingSurvey& survey, const UnitZero& zero, GuessedOutput& output) {
  for (GuessedGain& gain : output.gains) {
    gain.from_zero = has_offset(column_called(survey, gain.of));
    if (gain.from_zero) output.rest_value += gain.value * zero.value;
  }
  output.from_zero = !output.guess.integrates && has_offset(column_called(survey, output.name));
  if (!output.from_zero) return;
  output.rest_value -= zero.value;
  output.rest_doc += ", above 0 " + zero.unit;
}

/// Other outputs as drivers of one: only where every output with all its terms has room in a system.
bool may_couple(std::size_t outputs, std::size_t inputs) {
  const int n = static_cast<int>(outputs), terms = n + 2 + static_cast<int>(inputs);
  return n > 1 && 2 * n <= std::min(most_guessed.states, most_guessed.outputs) && n * terms <= most_guessed.parameters;
}

std::string unit_ratio(const std::string& above, const std::string& below) { return bind_unit("{a}/{b}", {{"a", above}, {"b", below}}); }

void take_gains(const GuessedModel& model, const std::vector<Candidate>& others, GuessedOutput& output) {
  const bool second = output.guess.order == 2;
  std::string driven = output.unit;
  if (output.guess.integrates) driven = second ? rate_unit(rate_unit(output.unit)) : rate_unit(output.unit);
  output.rest_unit = driven;
  output.rest_value = output.guess.rest;
  output.rest_doc = output.guess.integrates ? "rate of change without input"
                    : model.inputs.empty()  ? "equilibrium"
                                            : "output without input";
  for (std::size_t i = 0; i < output.guess.gain.size(); ++i) {
    if (output.guess.gain[i] == 0.0) continue;
    const bool input = i < model.inputs.size();
    const Candidate* other = input ? nullptr : &others[i - model.inputs.size()];
    const std::string of = input ? model.inputs[i] : other->column->name,
                      unit = input ? model.input_units[i] : unit_in_si(other->column->unit);
    const std::string doc = output.guess.integrates ? "what " + of + " adds to the rate of change" : "static gain of " + of;
    output.gains.push_back({"", of, unit_ratio(driven, unit), doc, output.guess.gain[i]});
  }
}

/// The output with signs, where it seems to be the size alone of what moves: as measured it would look like another system.
std::optional<std::vector<double>> values_with_signs(const Candidate& of, const GuessData& data) {
  Signals signals;
  signals.t = data.t;
  signals.measured.push_back({of.column->name, "", of.values});
  for (const GuessDriver& driver : data.drivers) signals.inputs.push_back({"", "", driver.values});
  const std::optional<SignedRecord> record = with_signs({signals}, of.column->name);
  return record ? std::optional(record->experiments.front().measured.front().values) : std::nullopt;
}

/// `data`: time, inputs and the outputs that may drive this one.
GuessedOutput guess_output(const RecordingSurvey& survey, const Table& table, const Candidate& of, GuessData data) {
  GuessedOutput output;
  const ColumnSurvey& c = *of.column;
  output.name = c.name;
  output.unit = unit_in_si(c.unit);
  data.y = of.values;
  data.without_inertia = parse_unit(output.unit).same_dimension(parse_unit("K"));
  output.noise = noise_of(data.y, c, output.unit);
  if (auto values = values_with_signs(of, data)) {
    data.y = std::move(*values);
    output.size_alone = true;
  }
  for (const ColumnSurvey* r : survey.of_use(ColumnUse::rate)) {
    if (r->rate_of != c.name) continue;
    output.rate = r->name;
    output.rate_unit = rate_unit(output.unit);
    data.rate = table.values(r->name, output.rate_unit);
    output.rate_noise = noise_of(data.rate, *r, output.rate_unit);
  }
  output.guess = guess_linear(data);
  return output;
}

/// The other outputs, where they may drive this one.
std::vector<Candidate> drivers_of(std::size_t which, const std::vector<Candidate>& all, std::size_t inputs) {
  if (!may_couple(all.size(), inputs)) return {};
  std::vector<Candidate> out = all;
  out.erase(out.begin() + which);
  return out;
}

GuessData with_drivers(GuessData data, const std::vector<Candidate>& drivers) {
  for (const Candidate& d : drivers) data.drivers.push_back({d.values, true, true});
  return data;
}

/// The last quarter: what text.cpp holds out.
void note_still_inputs(const Table& table, GuessedModel& model) {
  for (const std::string& input : model.inputs) {
    const std::vector<double>& values = table.at(input).values;
    if (changes_held_out_alone(values, 0, [&](std::size_t i) { return i >= values.size() * 3 / 4; }))
      model.remarks.push_back(fmt::format(
          "{} changes in the last quarter alone, which is held out: what it does cannot be found, hold out another part", input));
  }
}

void note_sizes(GuessedModel& model) {
  for (const GuessedOutput& output : model.outputs) {
    if (!output.size_alone) continue;
    model.remarks.push_back(fmt::format(
        "{} is never negative, and its past predicts it far better if it changes its sign where it comes to zero: if its size alone was "
        "measured (a rectifier, a toothed wheel), misfit discover says so; the first model is of {} with its sign",
        output.name, output.name));
  }
}

/// Inputs that the data want in no equation: a user who knows better is to see it.
void note_unneeded_inputs(GuessedModel& model) {
  std::vector<std::string> unneeded;
  for (const std::string& input : model.inputs) {
    const bool needed = std::any_of(model.outputs.begin(), model.outputs.end(), [&](const GuessedOutput& output) {
      return std::any_of(output.gains.begin(), output.gains.end(), [&](const GuessedGain& gain) { return gain.of == input; });
    });
    if (!needed) unneeded.push_back(input);
  }
  if (unneeded.empty()) return;
  model.remarks.push_back(
      fmt::format("in no equation of the first model: {}; with it, the held-out error hardly falls "
                  "(--input puts those that it names in the equations; misfit discover tests the others, as input_gain)",
                  fmt::join(unneeded, ", ")));
}

}  // namespace

const ColumnSurvey& column_called(const RecordingSurvey& survey, const std::string& name) {
  return *std::find_if(survey.columns.begin(), survey.columns.end(), [&](const ColumnSurvey& c) { return c.name == name; });
}

std::vector<std::string> names_of_formulas() { return formula::reserved_names(); }

GuessedModel guess_model(const RecordingSurvey& survey) {
  refuse_extremes(survey);
  GuessedModel model;
  const auto longest =
      std::max_element(survey.parts.begin(), survey.parts.end(), [](const Table& a, const Table& b) { return a.rows() < b.rows(); });
  GuessData data;
  data.t = longest->columns.front().values;
  guess_inputs(survey, *longest, model, data);
  const std::vector<std::string> reserved = names_of_formulas();
  std::set<std::string> taken(reserved.begin(), reserved.end());
  for (const auto& c : survey.columns) taken.insert(c.name);
  Room room;
  std::vector<std::string> left_out;
  std::vector<Candidate> outputs;
  model.zero = unit_zero(survey, taken);
  if (model.zero) --room.parameters;
  for (const ColumnSurvey* c : survey.of_use(ColumnUse::output)) outputs.push_back({c, longest->values(c->name, unit_in_si(c->unit))});
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const bool none_fits = room.states == 0 || room.outputs == 0;
    const std::vector<Candidate> drivers = drivers_of(i, outputs, model.inputs.size());
    GuessedOutput output = none_fits ? GuessedOutput{} : guess_output(survey, *longest, outputs[i], with_drivers(data, drivers));
    take_gains(model, drivers, output);
    if (model.zero && !none_fits) count_from_zero(survey, *model.zero, output);
    if (none_fits || !room.take(output)) {
      left_out.push_back(outputs[i].column->name);
      continue;
    }
    name_parts(taken, output);
    model.outputs.push_back(std::move(output));
  }
  const bool counted_from = std::any_of(model.outputs.begin(), model.outputs.end(), [](const GuessedOutput& output) {
    return output.from_zero ||
           std::any_of(output.gains.begin(), output.gains.end(), [](const GuessedGain& gain) { return gain.from_zero; });
  });
  if (!counted_from) model.zero.reset();
  note_left_out("outputs", left_out,
                fmt::format("a first model has at most {} outputs, {} states and {} parameters", most_guessed.outputs, most_guessed.states,
                            most_guessed.parameters),
                model.remarks);
  note_sizes(model);
  note_unneeded_inputs(model);
  note_still_inputs(*longest, model);
  return model;
}

}  // namespace misfit
