#include "misfit/workflow/simulate.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/table.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/data/estimators.h"
#include "misfit/inference/curves.h"
#include "misfit/inference/states.h"
#include "misfit/model/whole_steps.h"
#include "misfit/sim/planner.h"
#include "misfit/sim/random_run.h"
#include "misfit/workflow/estimate/estimate.h"
#include "misfit/workflow/stages.h"

namespace misfit {
namespace {

/// Where a simulation starts and what drives it.
struct Case {
  Model model;
  Signals signals;
  Eigen::VectorXd initial;
};

/// A number of [simulate], written with or without unit, in the model's unit.
double in_unit(const config::Number& number, const std::string& name, const std::string& unit) {
  if (number.unit.empty() || number.unit == "-") return number.value;
  if (!parse_unit(number.unit).same_dimension(parse_unit(unit)))
    throw InputError(number.where, name + " needs [" + unit + "], not [" + number.unit + "]");
  return number.value;
}

/// Knots for a curve given as a table: one per 0.25 of a degree or a hundredth of its range.
void knots_from_tables(const Session& session, ModelRequest& request) {
  for (const auto& [name, of] : curves_without_knots(request, session.registry)) {
    const auto curve = session.study.curves.find(name);
    if (curve == session.study.curves.end() || !curve->second.table)
      throw InputError({session.study.file.string(), 0, 0}, "to simulate, curve " + name + " needs a table: [curves] " + name +
                                                                " = { of = \"" + of + "\", table = \"FILE.csv\" }");
    const Table table = read_csv(*curve->second.table);
    const std::vector<double> x = table.values(of, table.at(of).unit == "deg" ? "rad" : table.at(of).unit);
    constexpr int intervals = 100;
    const double low = *std::min_element(x.begin(), x.end()), high = *std::max_element(x.begin(), x.end());
    request.curves[name].of = of;
    for (int i = 0; i <= intervals; ++i) request.curves[name].knots.push_back(low + (high - low) * i / intervals);
  }
}

void check_noise(const SimulateStudy& ask, const SystemSpec& spec) {
  std::vector<std::string> names;
  for (const auto& output : spec.outputs) names.push_back(output.name);
  for (const auto& [name, number] : ask.noise) {
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(number.where, "[simulate] noise: the system has no output '" + shown(name) + "'" + suggest(name, names));
  }
}

Case from_section(Session& session) {
  const SimulateStudy& ask = *session.study.simulate;
  ModelRequest request = session.model.request;
  add_camera(session, request);
  knots_from_tables(session, request);
  Case out{assemble(request, session.registry), {}, {}};
  check_noise(ask, out.model.system->spec());
  set_curves_from_tables(session, request, out.model);
  const auto samples = static_cast<std::size_t>(ask.duration / ask.step) + 1;
  out.signals.name = "simulation";
  for (std::size_t i = 0; i < samples; ++i) out.signals.t.push_back(static_cast<double>(i) * ask.step);
  for (const auto& input : out.model.system->spec().inputs)
    out.signals.inputs.push_back({input.name, input.unit, std::vector<double>(samples, 0.0), 0.0});
  const auto& states = out.model.system->spec().states;
  out.initial = Eigen::VectorXd::Zero(out.model.states());
  std::vector<std::string> names;
  for (const auto& state : states) names.push_back(state.name);
  Eigen::Index own = std::ssize(states);
  for (const auto& state : out.model.own_states) out.initial[own++] = state.initial;
  for (const auto& [name, number] : ask.initial) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      throw InputError(number.where, "[simulate] initial: the system has no state '" + shown(name) + "'" + suggest(name, names));
    out.initial[found - names.begin()] = in_unit(number, name, states[found - names.begin()].unit);
  }
  return out;
}

/// The fitted model of a run, over the experiment it was fitted to.
Case from_fit(Session& session) {
  const std::vector<Fit> fits = fit_stage(session);
  const auto usable = [](const Fit& fit) { return !fit.parameters.empty() && !find_estimator(fit.method)->regression_form; };
  const auto fit = std::find_if(fits.rbegin(), fits.rend(), usable);
  if (fit == fits.rend()) throw RunError("no method gave parameters to simulate with");
  Prepared prepared = prepare(session);
  for (auto& p : prepared.model.parameters) {
    const auto value = fit->parameters.find(p.name);
    if (value != fit->parameters.end()) p.value = value->second.value;
  }
  session.note("simulating with the parameters of " + fit->method);
  const ReconstructedStates states = reconstruct_states(prepared.model, prepared.experiments.front());
  const auto known = std::find(states.ok.begin(), states.ok.end(), true);
  if (known == states.ok.end()) throw RunError("no sample shows the states to start from");
  return {prepared.model, prepared.experiments.front(), states.x.row(known - states.ok.begin())};
}

/// The standard deviation of the noise that an output gets.
double noise_of(const OutputSpec& output, const Session& session) {
  if (!session.study.simulate) return 0.0;
  const auto found = session.study.simulate->noise.find(output.name);
  return found == session.study.simulate->noise.end() ? 0.0 : in_unit(found->second, output.name, output.unit);
}

/// An output of the model as it is measured: with noise of `sigma`, and then in whole steps, if it is read in such.
std::vector<double> measured(const Model& model, int output, const std::vector<double>& values, double sigma, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> out;
  for (const double value : values) out.push_back(as_read(model, output, value + sigma * normal(random)));
  if (!std::all_of(out.begin(), out.end(), [](double v) { return std::isfinite(v); }))
    throw RunError("output " + model.system->spec().outputs[output].name + " with noise of sigma " + format_value(sigma) +
                   " is not finite");
  return out;
}

/// A column NAME, and NAME_true beside it where NAME is measured with noise or in steps.
void add_output(Table& table, const OutputSpec& output, std::vector<double> values, std::vector<double> read) {
  const std::string unit = display_level_unit(output.unit);
  const bool as_it_is = read == values;
  for (std::vector<double>* column : {&values, &read}) {
    for (double& v : *column) v = convert(v, output.unit, unit);
  }
  table.add(output.name, unit, std::move(read));
  if (!as_it_is) table.add(output.name + "_true", unit, std::move(values));
}

Table simulate(const Case& c, const Session& session) {
  const Model before = before_whole_steps(c.model);
  Stepper stepper(before);
  InputTable inputs = input_table(c.signals, before);
  std::mt19937_64 random(session.study.seed);
  Segment run;
  if (has_random_states(stepper.evaluator(), c.initial.data(), inputs.at(0), c.signals.t.front())) {
    run_randomly({stepper, c.signals, inputs}, c.initial.data(), random, run);
  } else {
    inputs.plan = plan_run({stepper, c.signals, inputs}, c.initial.data());
    if (!inputs.plan.lack.empty()) throw RunError(inputs.plan.lack);
    run_segment({stepper, c.signals, inputs}, {0, c.signals.samples(), c.initial.data()}, run);
  }
  if (!run.finite) throw RunError("simulation diverged (non-finite state) at t = " + format_value(c.signals.t[run.failed_at]) + " s");
  Table table;
  table.add("t", "s", c.signals.t);
  for (int o = 0; o < c.model.outputs(); ++o) {
    const OutputSpec& output = c.model.system->spec().outputs[o];
    const std::vector<double> values(run.y.col(o).begin(), run.y.col(o).end());
    add_output(table, output, values, measured(c.model, o, values, noise_of(output, session), random));
  }
  return table;
}

}  // namespace

SimulatedRecord simulate_stage(Session& session) {
  const Case c = session.study.simulate ? from_section(session) : from_fit(session);
  SimulatedRecord out{simulate(c, session), c.model.system->spec().key, session.folder.file("simulation.csv")};
  session.redo_stage("simulate", session.inputs(session.study.text, {}), {"simulation.csv"},
                     [&](const std::filesystem::path& dir) { write_csv(dir / "simulation.csv", out.table); });
  return out;
}

}  // namespace misfit
