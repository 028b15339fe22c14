#include "misfit/workflow/init/drivers.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "misfit/core/units.h"
#include "misfit/fit/regression/influence.h"
#include "misfit/fit/regression/linear_guess.h"
#include "misfit/recording/column_facts.h"

namespace misfit {
namespace {

/// What moves in the file, as a first look has it.
struct Columns {
  std::vector<double> t;                                       ///< [s]
  std::map<std::string, std::vector<double>> inputs, outputs;  ///< outputs: rates too

  [[nodiscard]] Influence influence_on(const std::string& name) const {
    std::vector<std::vector<double>> others, drivers;
    for (const auto& [other, values] : outputs) {
      if (other != name) others.push_back(values);
    }
    for (const auto& [other, values] : inputs) drivers.push_back(values);
    return misfit::influence_on(outputs.at(name), others, drivers);
  }
  /// By the inputs, over windows of two swings or more: what heats the place of a sensor through walls shows later than a past slope does.
  /// An input may follow it, too (a thermostat), and then predicts it by less.
  [[nodiscard]] bool is_driven(const std::string& name) const {
    constexpr double clearly = 4.0;  // times the mean square
    GuessData data{t, outputs.at(name), {}, {}};
    for (const auto& [input, values] : inputs) data.drivers.push_back({values, false, false, false});
    return !inputs.empty() && guess_linear(data).undriven > clearly;
  }
};

bool is_in(const ColumnSurvey& c, const char* unit) { return c.unit != "-" && parse_unit(c.unit).same_dimension(parse_unit(unit)); }

/// A temperature that nothing in the file helps to predict is that of the surroundings of another one, even where it moves too little or
/// too slowly for that to show. What is numbered like another column (T_1, T_2) is a place as that one is.
void take_what_nothing_predicts(RecordingSurvey& survey) {
  const auto longest =
      std::max_element(survey.parts.begin(), survey.parts.end(), [](const Table& a, const Table& b) { return a.rows() < b.rows(); });
  Columns all;
  all.t = longest->columns.front().values;
  std::vector<ColumnSurvey*> outputs;
  for (auto& c : survey.columns) {
    const bool input = c.use == ColumnUse::input, output = c.use == ColumnUse::output;
    if (input || output || c.use == ColumnUse::rate) (input ? all.inputs : all.outputs)[c.name] = longest->find(c.name)->values;
    if (output && !c.chosen_by_user) outputs.push_back(&c);
  }
  constexpr std::size_t most = 24;  // columns; with more of them the regressions say little
  if (outputs.size() < 2 || all.inputs.size() + all.outputs.size() > most) return;
  std::map<std::string, Influence> found;
  for (const ColumnSurvey* c : outputs) found[c->name] = all.influence_on(c->name);
  for (ColumnSurvey* c : outputs) {
    constexpr double by_itself = 0.9;
    const auto moved = [&](const ColumnSurvey* d) {
      return found[d->name].matters() && (found[c->name].own > by_itself || (is_in(*c, "K") && is_in(*d, "K")) ||
                                          influence_on(all.outputs[d->name], {all.outputs[c->name]}).matters());
    };
    const auto helped = std::find_if(outputs.begin(), outputs.end(), moved);
    const bool one_of_several =
        std::any_of(outputs.begin(), outputs.end(), [&](const ColumnSurvey* d) { return are_numbered_alike(c->name, d->name); });
    if (found[c->name].matters() || helped == outputs.end() || one_of_several || all.is_driven(c->name)) continue;
    c->use = ColumnUse::input;
    c->is_measured_input = !jumps(longest->find(c->name)->values);
    c->why = "nothing else in the file helps to predict it, unlike " + (*helped)->name;
  }
}

/// Of "t_in" and "t_out" the second is outdoors, unless the data have said that the first drives it.
void take_outdoors(RecordingSurvey& survey) {
  const auto is_output = [](const ColumnSurvey& c) { return c.use == ColumnUse::output; };
  for (ColumnSurvey& out : survey.columns) {
    const bool beside_one = std::any_of(survey.columns.begin(), survey.columns.end(),
                                        [&](const ColumnSurvey& in) { return is_output(in) && are_called_in_and_out(in.name, out.name); });
    if (!is_output(out) || out.chosen_by_user || !beside_one || !is_called_input(out.name)) continue;
    out.use = ColumnUse::input;
    out.is_measured_input = true;
    out.why = "named like an input";
  }
}

/// The only current beside positions, angles and speeds drives them (a motor, a coil), where nothing else in the file does. Under a
/// controller the motion predicts the current, too, so that the data do not say which drives which.
void take_current_beside_motion(RecordingSurvey& survey) {
  ColumnSurvey* current = nullptr;
  bool moves = false;
  for (ColumnSurvey& c : survey.columns) {
    if (c.use == ColumnUse::input) return;
    if (c.use != ColumnUse::output && c.use != ColumnUse::rate) continue;
    const bool motion = is_in(c, "m") || is_in(c, "m/s") || is_in(c, "rad") || is_in(c, "rad/s");
    if (!motion && (current != nullptr || c.use == ColumnUse::rate || c.chosen_by_user || !is_in(c, "A"))) return;
    moves |= motion;
    if (!motion) current = &c;
  }
  if (current == nullptr || !moves) return;
  current->use = ColumnUse::input;
  current->is_measured_input = true;
  current->why = "the only current, beside what moves";
}

}  // namespace

void take_measured_inputs(RecordingSurvey& survey) {
  take_what_nothing_predicts(survey);
  take_outdoors(survey);
  take_current_beside_motion(survey);
}

}  // namespace misfit
