#include "misfit/workflow/init/drivers.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "misfit/fit/regression/influence.h"
#include "misfit/recording/column_facts.h"

namespace misfit {
namespace {

/// What moves in the file, as a first look has it.
struct Columns {
  std::map<std::string, std::vector<double>> inputs, outputs;  ///< outputs: rates too

  [[nodiscard]] Influence influence_on(const std::string& name) const {
    std::vector<std::vector<double>> others, drivers;
    for (const auto& [other, values] : outputs) {
      if (other != name) others.push_back(values);
    }
    for (const auto& [other, values] : inputs) drivers.push_back(values);
    return misfit::influence_on(outputs.at(name), others, drivers);
  }
};

void take_what_nothing_predicts(RecordingSurvey& survey) {
  const auto longest =
      std::max_element(survey.parts.begin(), survey.parts.end(), [](const Table& a, const Table& b) { return a.rows() < b.rows(); });
  Columns all;
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
      return found[d->name].matters() &&
             (found[c->name].own > by_itself || influence_on(all.outputs[d->name], {all.outputs[c->name]}).matters());
    };
    const auto helped = std::find_if(outputs.begin(), outputs.end(), moved);
    if (found[c->name].matters() || helped == outputs.end()) continue;
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

}  // namespace

void take_measured_inputs(RecordingSurvey& survey) {
  take_what_nothing_predicts(survey);
  take_outdoors(survey);
}

}  // namespace misfit
