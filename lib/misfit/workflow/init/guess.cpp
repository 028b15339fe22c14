#include "misfit/workflow/init/guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/core/unique_name.h"
#include "misfit/core/units.h"
#include "misfit/formula/syntax.h"
#include "misfit/inference/states.h"
#include "misfit/model/limits.h"

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

/// What a declared system still takes.
struct Room {
  int states = kMaxStates, outputs = kMaxOutputs, parameters = kMaxConstants;

  bool take(const GuessedOutput& output, std::size_t inputs) {
    const bool oscillatory = output.guess.order == 2;
    const int of_states = oscillatory ? 2 : 1, of_outputs = oscillatory && !output.rate.empty() ? 2 : 1;
    const int of_parameters = (oscillatory ? 3 : 2) + static_cast<int>(inputs);
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
                                fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(names.size() - more), ", "),
                                more > 0 ? fmt::format(" and {} more", more) : "", limit));
}

/// Names for what the equation of an output needs, each unlike all others.
void name_parts(const GuessedModel& model, std::set<std::string>& taken, GuessedOutput& output) {
  const auto part = [&](const char* end) { return unique_name(output.name + end, taken); };
  if (output.guess.order == 2) {
    output.rate_state = output.rate.empty() ? part("_rate") : output.rate;
    output.stiffness = part("_stiffness");
    output.damping = part("_damping");
  } else {
    output.tau = part("_tau");
  }
  for (const auto& input : model.inputs) output.gains.push_back(unique_name(output.name + "_gain_" + input, taken));
  output.rest = part("_rest");
}

void guess_inputs(const RecordingSurvey& survey, const Table& table, GuessedModel& model, GuessData& data) {
  std::vector<std::string> left_out;
  for (const ColumnSurvey* c : survey.of_use(ColumnUse::input)) {
    if (std::ssize(model.inputs) == kMaxInputs) {
      left_out.push_back(c->name);
      continue;
    }
    model.inputs.push_back(c->name);
    model.input_units.push_back(si_unit(c->unit));
    const bool steps = c->held > 0.2;
    model.hold_reasons.emplace_back(
        steps ? "" : "; a computer's output is held until the next sample, \"first_order\" if it was measured between");
    data.inputs.push_back(table.values(c->name, model.input_units.back()));
  }
  note_left_out("inputs", left_out, fmt::format("a system has at most {} inputs", kMaxInputs), model.remarks);
}

GuessedOutput guess_output(const RecordingSurvey& survey, const Table& table, const ColumnSurvey& c, GuessData& data) {
  GuessedOutput output;
  output.name = c.name;
  output.unit = si_unit(c.unit);
  data.y = table.values(c.name, output.unit);
  output.noise = noise_of(data.y, c, output.unit);
  output.guess = guess_linear(data);
  for (const ColumnSurvey* r : survey.of_use(ColumnUse::rate)) {
    if (r->rate_of != c.name) continue;
    output.rate = r->name;
    output.rate_unit = rate_unit(output.unit);
    output.rate_noise = noise_of(table.values(r->name, output.rate_unit), *r, output.rate_unit);
  }
  return output;
}

}  // namespace

std::string si_unit(const std::string& unit) { return unit_in_si(unit); }

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
  for (const ColumnSurvey* c : survey.of_use(ColumnUse::output)) {
    const bool none_fits = room.states == 0 || room.outputs == 0;
    GuessedOutput output = none_fits ? GuessedOutput{} : guess_output(survey, *longest, *c, data);
    if (none_fits || !room.take(output, model.inputs.size())) {
      left_out.push_back(c->name);
      continue;
    }
    name_parts(model, taken, output);
    model.outputs.push_back(std::move(output));
  }
  note_left_out("outputs", left_out,
                fmt::format("a system has at most {} outputs, {} states and {} parameters", kMaxOutputs, kMaxStates, kMaxConstants),
                model.remarks);
  return model;
}

}  // namespace misfit
